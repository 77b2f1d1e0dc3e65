// SPDX-License-Identifier: Apache-2.0
#include "render_node/grid/vertex_pages.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "render_node/gl/vertex_attribute.hpp"
#include "render_node/grid/free_ranges.hpp"

namespace render_node {
namespace {

constexpr std::size_t kMostUnsent = 1 << 13;  // [vertex], so that a new view of a large field needs no second copy

/// Describes the layout of GridVertex in the bound vertex array.
void describeVertex() {
    constexpr auto attribute = describeAttribute<shapes::GridVertex>;
    attribute(0, 1, GL_FLOAT, GL_FALSE, offsetof(shapes::GridVertex, height));
    attribute(1, 2, GL_UNSIGNED_SHORT, GL_FALSE, offsetof(shapes::GridVertex, column));
    attribute(2, 2, GL_SHORT, GL_TRUE, offsetof(shapes::GridVertex, normalEast));
    attribute(3, 2, GL_UNSIGNED_SHORT, GL_TRUE, offsetof(shapes::GridVertex, open));
}

}  // namespace

class VertexPages::Page {
public:
    Page(int count, std::shared_ptr<std::int64_t> used) : places_(count), count_(count), used_(std::move(used)) {
        glBindVertexArray(array_.id());
        glBindBuffer(GL_ARRAY_BUFFER, buffer_.id());
        glBufferData(GL_ARRAY_BUFFER, bytesOf<shapes::GridVertex>(count), nullptr, GL_DYNAMIC_DRAW);
        describeVertex();
    }

    void send(int first, std::span<const shapes::GridVertex> vertices) const {
        glBindBuffer(GL_ARRAY_BUFFER, buffer_.id());
        glBufferSubData(GL_ARRAY_BUFFER, bytesOf<shapes::GridVertex>(first),
                        bytesOf<shapes::GridVertex>(vertices.size()), vertices.data());
    }

    void bind(GLuint indices) {
        glBindVertexArray(array_.id());
        if (indices_ != indices) {  // the vertex array keeps it
            glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
            indices_ = indices;
        }
    }

    [[nodiscard]] std::size_t bytes() const { return static_cast<std::size_t>(count_) * sizeof(shapes::GridVertex); }

    [[nodiscard]] std::optional<int> take(int count) {
        if (count > mostFree_) {
            return std::nullopt;  // without a search, because most pages are full
        }
        const std::optional<int> first = places_.take(count);
        mostFree_ = first ? mostFree_ : count - 1;
        *used_ += first ? count : 0;
        return first;
    }
    void giveBack(int first, int count) {
        places_.giveBack(first, count);
        mostFree_ = count_;
        *used_ -= count;
    }

private:
    FreeRanges places_;
    int count_, mostFree_ = count_;       // no free range is longer than mostFree_
    std::shared_ptr<std::int64_t> used_;  // vertices of all ranges of all pages
    GlVertexArray array_;
    GlBuffer buffer_;
    GLuint indices_ = 0;
};

VertexPages::Range::Range(std::shared_ptr<Page> page, int first, int count)
    : page_(std::move(page)), first_(first), count_(count) {}

VertexPages::Range::Range(Range&& other) noexcept
    : page_(std::move(other.page_)), first_(other.first_), count_(std::exchange(other.count_, 0)) {}

VertexPages::Range& VertexPages::Range::operator=(Range&& other) noexcept {
    std::swap(page_, other.page_);
    std::swap(first_, other.first_);
    std::swap(count_, other.count_);
    return *this;
}

VertexPages::Range::~Range() {
    if (page_) {
        page_->giveBack(first_, count_);
    }
}

void VertexPages::Range::bind(GLuint indices) const { page_->bind(indices); }

VertexPages::Range VertexPages::allocate(int count) {
    std::erase_if(pages_, [](const std::weak_ptr<Page>& page) { return page.expired(); });
    for (const std::weak_ptr<Page>& known : pages_) {
        const std::shared_ptr<Page> page = known.lock();
        if (const std::optional<int> first = page->take(count)) {
            return {page, *first, count};
        }
    }
    const auto page = std::make_shared<Page>(std::max(count, perPage_), used_);
    pages_.push_back(page);
    return {page, page->take(count).value(), count};
}

void VertexPages::write(const Range& range, int offset, std::span<const shapes::GridVertex> vertices) {
    const int first = range.first_ + offset;
    const bool adjacent = unsentPage_ == range.page_ && unsentFirst_ + static_cast<int>(unsent_.size()) == first;
    if (!adjacent || unsent_.size() + vertices.size() > kMostUnsent) {
        send();
        unsentPage_ = range.page_;
        unsentFirst_ = first;
    }
    unsent_.insert(unsent_.end(), vertices.begin(), vertices.end());
}

void VertexPages::send() {
    if (unsentPage_) {
        unsentPage_->send(unsentFirst_, unsent_);
    }
    unsentPage_.reset();
    unsent_.clear();
}

std::size_t VertexPages::bytes() const {
    std::size_t bytes = 0;
    for (const std::weak_ptr<Page>& known : pages_) {
        if (const std::shared_ptr<Page> page = known.lock()) {
            bytes += page->bytes();
        }
    }
    return bytes;
}

}  // namespace render_node
