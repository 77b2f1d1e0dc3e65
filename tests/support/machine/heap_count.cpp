// SPDX-License-Identifier: Apache-2.0
#include "tests/support/machine/heap_count.hpp"

#include <cstdlib>
#include <new>

namespace {

thread_local long requests = 0;
thread_local std::size_t requestedBytes = 0;

}  // namespace

long test::heapRequests() { return requests; }
std::size_t test::heapBytes() { return requestedBytes; }

// Both forms of new for one object are replaced, because the sanitizers' forms do not call each other, as those of the
// library do. So memory of new[] is counted only without a sanitizer.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    ++requests;
    requestedBytes += size;
    return std::malloc(size == 0 ? 1 : size);
}
void* operator new(std::size_t size) {
    if (void* memory = operator new(size, std::nothrow)) {
        return memory;
    }
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
