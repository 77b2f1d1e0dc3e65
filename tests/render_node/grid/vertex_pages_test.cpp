// SPDX-License-Identifier: Apache-2.0
#include "render_node/grid/vertex_pages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <random>
#include <set>
#include <vector>

#include "render_node/gl/gl_context.hpp"
#include "render_node/grid/free_ranges.hpp"
#include "render_node/grid/index_lists.hpp"
#include "tests/support/seed.hpp"

namespace {

using render_node::VertexPages;
using shapes::GridVertex;

TEST(FreeRanges, AreTakenOnceAndJoinAgain) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    constexpr int kPlaces = 200;
    render_node::FreeRanges places(kPlaces);
    std::vector<std::pair<int, int>> taken;
    std::set<int> used;
    for (int i = 0; i < 2000; ++i) {
        if (random() % 2 == 0 || taken.empty()) {
            const int count = 1 + static_cast<int>(random() % 20U);
            const std::optional<int> first = places.take(count);
            for (int place = *first; first && place < *first + count; ++place) {
                ASSERT_TRUE(place < kPlaces && used.insert(place).second) << place;
            }
            if (first) {
                taken.emplace_back(*first, count);
            }
        } else {
            std::swap(taken[random() % taken.size()], taken.back());
            const auto [first, count] = taken.back();
            taken.pop_back();
            for (int place = first; place < first + count; ++place) {
                used.erase(place);
            }
            places.giveBack(first, count);
        }
    }
    for (const auto& [first, count] : taken) {
        places.giveBack(first, count);
    }
    EXPECT_EQ(places.take(kPlaces), 0);
    EXPECT_EQ(places.take(1), std::nullopt);
}

class Pages : public testing::Test {
protected:
    static constexpr int kPerPage = 100;
    static constexpr std::size_t kPageBytes = kPerPage * sizeof(GridVertex);

    /// Returns vertices that no other call returns.
    std::vector<GridVertex> vertices(int count) {
        std::vector<GridVertex> made(static_cast<std::size_t>(count));
        for (GridVertex& vertex : made) {
            vertex.height = static_cast<float>(++made_);
        }
        return made;
    }
    static bool holds(const VertexPages::Range& range, const std::vector<GridVertex>& expected) {
        range.bind(0);
        GLint buffer = 0;
        glGetVertexAttribiv(0, GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING, &buffer);
        glBindBuffer(GL_ARRAY_BUFFER, static_cast<GLuint>(buffer));
        std::vector<GridVertex> sent(expected.size());
        glGetBufferSubData(GL_ARRAY_BUFFER, render_node::bytesOf<GridVertex>(range.first()),
                           render_node::bytesOf<GridVertex>(sent.size()), sent.data());
        return std::ranges::equal(sent, expected, {}, &GridVertex::height, &GridVertex::height);
    }

    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
    VertexPages pages_{kPerPage};

private:
    int made_ = 0;
};

TEST_F(Pages, HoldWhatWasWrittenLast) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    struct Kept {
        VertexPages::Range range;
        std::vector<GridVertex> content;
    };
    std::vector<Kept> kept;
    for (int i = 0; i < 500; ++i) {
        const unsigned what = random() % 4U;
        if (what < 2 || kept.empty()) {
            const int count = 1 + static_cast<int>(random() % 40U);
            kept.push_back({pages_.allocate(count), vertices(count)});
            pages_.write(kept.back().range, 0, kept.back().content);
        } else if (what == 2) {
            std::swap(kept[random() % kept.size()], kept.back());
            kept.pop_back();
        } else {  // a part of the vertices changes
            auto& [range, content] = kept[random() % kept.size()];
            const auto offset = random() % content.size();
            const std::vector<GridVertex> part = vertices(static_cast<int>(content.size() - offset));
            std::ranges::copy(part, content.begin() + static_cast<std::ptrdiff_t>(offset));
            pages_.write(range, static_cast<int>(offset), part);
        }
        if (i % 50 == 0) {
            pages_.send();
            for (const auto& [range, content] : kept) {
                ASSERT_TRUE(holds(range, content)) << i;
            }
        }
    }
}

TEST_F(Pages, AreSharedWhileThereIsRoom) {
    const VertexPages::Range first = pages_.allocate(60), second = pages_.allocate(40), third = pages_.allocate(1);
    EXPECT_TRUE(first.sharesPageWith(second));
    EXPECT_FALSE(first.sharesPageWith(third));
    EXPECT_EQ(pages_.bytes(), 2 * kPageBytes);
}

TEST_F(Pages, GiveThePlaceOfADestroyedRangeToAnother) {
    VertexPages::Range first = pages_.allocate(60);
    const VertexPages::Range second = pages_.allocate(40);
    first = {};
    first = pages_.allocate(60);
    EXPECT_TRUE(first.sharesPageWith(second));
    EXPECT_EQ(pages_.bytes(), kPageBytes);
}

TEST_F(Pages, AreDeletedWithTheirLastRange) {
    std::vector<VertexPages::Range> ranges(6);
    std::ranges::generate(ranges, [this] { return pages_.allocate(kPerPage / 2); });
    EXPECT_EQ(pages_.bytes(), 3 * kPageBytes);
    ranges.erase(ranges.begin() + 1, ranges.begin() + 4);  // half of the first page, and the second one
    EXPECT_EQ(pages_.bytes(), 2 * kPageBytes);
    ranges.clear();
    EXPECT_EQ(pages_.bytes(), 0U);
}

TEST_F(Pages, AreAsLongAsTheirLongestRange) {
    const VertexPages::Range range = pages_.allocate(3 * kPerPage);
    const std::vector<GridVertex> content = vertices(3 * kPerPage);
    pages_.write(range, 0, content);
    pages_.send();
    EXPECT_TRUE(holds(range, content));
    EXPECT_EQ(pages_.bytes(), 3 * kPageBytes);
}

// A page binds the buffer of the indices once.
TEST_F(Pages, IndicesStayWhileTheirBufferGrows) {
    render_node::IndexLists lists;
    const VertexPages::Range range = pages_.allocate(1);
    range.bind(lists.buffer());
    std::vector<std::uint16_t> expected;
    for (std::size_t i = 1; i < 60; ++i) {
        const std::vector<std::uint16_t> added(i * i, static_cast<std::uint16_t>(i));
        ASSERT_EQ(lists.add(added), static_cast<int>(expected.size()));
        expected.insert(expected.end(), added.begin(), added.end());
    }
    std::vector<std::uint16_t> sent(expected.size());
    range.bind(lists.buffer());
    glGetBufferSubData(GL_ELEMENT_ARRAY_BUFFER, 0, render_node::bytesOf<std::uint16_t>(sent.size()), sent.data());
    EXPECT_EQ(sent, expected);
    EXPECT_LE(lists.bytes(), 2 * expected.size() * sizeof(std::uint16_t));
}

}  // namespace
