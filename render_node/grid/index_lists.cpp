// SPDX-License-Identifier: Apache-2.0
#include "render_node/grid/index_lists.hpp"

#include <algorithm>
#include <utility>

namespace render_node {

int IndexLists::add(std::span<const std::uint16_t> indices) {
    const std::size_t first = count_;
    if (first + indices.size() > capacity_) {
        grow(first + indices.size());
    }
    // The name of this target keeps every vertex array as it is.
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffer_.id());
    glBufferSubData(GL_COPY_WRITE_BUFFER, bytesOf<std::uint16_t>(first), bytesOf<std::uint16_t>(indices.size()),
                    indices.data());
    count_ += indices.size();
    return static_cast<int>(first);
}

void IndexLists::grow(std::size_t needed) {
    capacity_ = std::max(needed, capacity_ + capacity_ / 2);
    GlBuffer grown;
    glBindBuffer(GL_COPY_WRITE_BUFFER, grown.id());
    glBufferData(GL_COPY_WRITE_BUFFER, bytesOf<std::uint16_t>(capacity_), nullptr, GL_STATIC_DRAW);
    if (count_ > 0) {
        glBindBuffer(GL_COPY_READ_BUFFER, buffer_.id());
        glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, bytesOf<std::uint16_t>(count_));
    }
    std::swap(buffer_, grown);
}

}  // namespace render_node
