// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "render_node/gl/gl_handle.hpp"
#include "shapes/grid/vertices.hpp"

namespace render_node {

/// Vertex buffers that many chunks share, so that one call draws many chunks. A page is one buffer in GL.
///
/// Used by one thread, with its context current.
class VertexPages {
    class Page;

public:
    /// Vertices in one page. They belong to this object until it is destroyed. A page is deleted with its last range.
    class Range {
    public:
        Range() = default;
        Range(std::shared_ptr<Page> page, int first, int count);
        Range(Range&& other) noexcept;
        Range& operator=(Range&& other) noexcept;
        ~Range();
        [[nodiscard]] int first() const { return first_; }  // number of the first vertex in the page
        [[nodiscard]] int count() const { return count_; }
        [[nodiscard]] bool sharesPageWith(const Range& other) const { return page_ == other.page_; }
        /// Binds the page's vertex array, and `indices` as the buffer of its indices.
        void bind(GLuint indices) const;

    private:
        friend class VertexPages;
        std::shared_ptr<Page> page_;
        int first_ = 0, count_ = 0;
    };

    /// `perPage` is the number of vertices in a page. A longer range gets a page of its own length.
    explicit VertexPages(int perPage) : perPage_(perPage) {}

    /// Returns `count` vertices without content, in the first page that has room.
    [[nodiscard]] Range allocate(int count);
    /// Sets vertices of a range, from vertex `offset` of the range on. GL gets them with the next send() at the latest.
    void write(const Range& range, int offset, std::span<const shapes::GridVertex> vertices);
    /// Sends to GL what write() has set. Vertices that are adjacent in a page travel in one call.
    void send();
    /// Returns the memory of all pages [byte].
    [[nodiscard]] std::size_t bytes() const;
    /// Returns the memory of all ranges [byte].
    [[nodiscard]] std::size_t usedBytes() const {
        return static_cast<std::size_t>(*used_) * sizeof(shapes::GridVertex);
    }

private:
    int perPage_;
    std::shared_ptr<std::int64_t> used_ = std::make_shared<std::int64_t>(0);  // vertices of all ranges
    std::vector<std::weak_ptr<Page>> pages_;
    // Vertices that are not sent yet, and the place of the first one.
    std::shared_ptr<Page> unsentPage_;
    int unsentFirst_ = 0;
    std::vector<shapes::GridVertex> unsent_;
};

}  // namespace render_node
