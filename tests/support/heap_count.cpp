// SPDX-License-Identifier: Apache-2.0
#include "tests/support/heap_count.hpp"

#include <cstdlib>
#include <new>

namespace {

thread_local long requests = 0;

}  // namespace

long test::heapRequests() { return requests; }

void* operator new(std::size_t size) {
    ++requests;
    if (void* memory = std::malloc(size == 0 ? 1 : size)) {
        return memory;
    }
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
