// SPDX-License-Identifier: Apache-2.0
#include "base/zeroed_memory.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace base {
namespace {

constexpr std::size_t kPage = 4096;  // [byte]; a multiple of it is a page on some machines

/// Returns whether `size` bytes are 0. There is at least one.
bool isZero(const std::byte* bytes, std::size_t size) {
    return *bytes == std::byte{0} && std::memcmp(bytes, bytes + 1, size - 1) == 0;
}

std::byte* zeroed(std::size_t size) {
    // The C library does not write a large block that the system has just given.
    auto* const bytes = static_cast<std::byte*>(std::calloc(std::max<std::size_t>(size, 1), 1));
    if (bytes == nullptr) {
        throw std::bad_alloc();
    }
    return bytes;
}

}  // namespace

void ZeroedMemory::Free::operator()(std::byte* bytes) const { std::free(bytes); }

ZeroedMemory::ZeroedMemory(std::size_t size) : size_(size), bytes_(zeroed(size)) {}

ZeroedMemory::ZeroedMemory(const ZeroedMemory& other) : ZeroedMemory(other.size_) {
    for (std::size_t at = 0; at < size_; at += kPage) {
        const std::size_t size = std::min(kPage, size_ - at);
        if (!isZero(other.data() + at, size)) {
            std::memcpy(data() + at, other.data() + at, size);
        }
    }
}

ZeroedMemory& ZeroedMemory::operator=(const ZeroedMemory& other) {
    if (this == &other || (size_ == 0 && other.size_ == 0)) {
        return *this;
    }
    if (size_ == other.size_) {
        std::memcpy(data(), other.data(), size_);
    } else {
        *this = ZeroedMemory(other);
    }
    return *this;
}

ZeroedMemory::ZeroedMemory(ZeroedMemory&& other) noexcept
    : size_(std::exchange(other.size_, 0)), bytes_(std::move(other.bytes_)) {}

ZeroedMemory& ZeroedMemory::operator=(ZeroedMemory&& other) noexcept {
    size_ = std::exchange(other.size_, 0);
    bytes_ = std::move(other.bytes_);
    return *this;
}

void ZeroedMemory::release(std::size_t first, std::size_t end) {
#if defined(__linux__)
    constexpr std::uintptr_t kMost = 65536;  // [byte] of a page of any Linux
    const auto start = reinterpret_cast<std::uintptr_t>(data());
    const std::uintptr_t from = (start + first + kMost - 1) / kMost * kMost, to = (start + end) / kMost * kMost;
    if (from < to) {
        // The next read or write gets new pages of zeros. An error leaves the zeros that are there.
        (void)madvise(reinterpret_cast<void*>(from), to - from, MADV_DONTNEED);  // NOLINT(performance-no-int-to-ptr)
    }
#else
    (void)first;
    (void)end;
#endif
}

}  // namespace base
