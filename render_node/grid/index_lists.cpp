// SPDX-License-Identifier: Apache-2.0
#include "render_node/grid/index_lists.hpp"

#include <algorithm>

namespace render_node {

int IndexLists::add(std::span<const std::uint16_t> indices) {
    const std::size_t first = count_;
    if (first + indices.size() > capacity_) {
        grow(first + indices.size());
    }
    // Binding to this target changes no vertex array.
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffer_.id());
    glBufferSubData(GL_COPY_WRITE_BUFFER, bytesOf<std::uint16_t>(first), bytesOf<std::uint16_t>(indices.size()),
                    indices.data());
    count_ += indices.size();
    return static_cast<int>(first);
}

void IndexLists::grow(std::size_t needed) {
    const auto kept = bytesOf<std::uint16_t>(count_);
    const GlBuffer copy;
    glBindBuffer(GL_COPY_READ_BUFFER, copy.id());
    glBufferData(GL_COPY_READ_BUFFER, kept, nullptr, GL_STREAM_COPY);
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffer_.id());
    if (count_ > 0) {
        glCopyBufferSubData(GL_COPY_WRITE_BUFFER, GL_COPY_READ_BUFFER, 0, 0, kept);
    }
    capacity_ = std::max(needed, capacity_ + capacity_ / 2);
    glBufferData(GL_COPY_WRITE_BUFFER, bytesOf<std::uint16_t>(capacity_), nullptr, GL_STATIC_DRAW);
    if (count_ > 0) {
        glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, kept);
    }
}

}  // namespace render_node
