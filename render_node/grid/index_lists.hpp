// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "render_node/gl/gl_handle.hpp"

namespace render_node {

/// Lists of indices in one buffer in GL, so that one call draws chunks with different lists. They stay until this
/// object is destroyed.
///
/// Used by one thread, with its context current.
class IndexLists {
public:
    /// Copies indices to GL. Returns the place of the first one in the buffer.
    [[nodiscard]] int add(std::span<const std::uint16_t> indices);
    /// Returns the buffer, which stays the same while it grows: vertex arrays hold it.
    [[nodiscard]] GLuint buffer() const { return buffer_.id(); }
    [[nodiscard]] std::size_t bytes() const { return capacity_ * sizeof(std::uint16_t); }

private:
    void grow(std::size_t needed);
    GlBuffer buffer_;
    std::size_t count_ = 0, capacity_ = 0;  // [index]
};

}  // namespace render_node
