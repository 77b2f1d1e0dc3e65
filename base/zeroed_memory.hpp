// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

namespace base {

/// Block of memory whose bytes are 0 at first.
///
/// A large block takes memory only for pages that were written. Reading other pages takes none. Not thread-safe, except
/// that threads may use different bytes.
class ZeroedMemory {
public:
    /// Throws std::bad_alloc.
    explicit ZeroedMemory(std::size_t size /* [byte] */);
    /// Copies only pages that are not 0.
    ZeroedMemory(const ZeroedMemory& other);
    ZeroedMemory& operator=(const ZeroedMemory& other);
    ZeroedMemory(ZeroedMemory&& other) noexcept;
    ZeroedMemory& operator=(ZeroedMemory&& other) noexcept;
    ~ZeroedMemory() = default;

    [[nodiscard]] std::size_t size() const { return size_; }  // [byte]
    [[nodiscard]] std::byte* data() { return bytes_.get(); }
    [[nodiscard]] const std::byte* data() const { return bytes_.get(); }

    /// Gives pages within the bytes [first, end) back to the system. All these bytes must be 0, and stay so.
    void release(std::size_t first, std::size_t end);

private:
    struct Free {
        void operator()(std::byte* bytes) const;
    };
    std::size_t size_;
    std::unique_ptr<std::byte, Free> bytes_;
};

}  // namespace base
