// SPDX-License-Identifier: Apache-2.0
#include "render_node/surface/change_history.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <set>

#include "render_node/grid/mesh.hpp"
#include "shapes/model/box.hpp"

namespace history {
namespace {

/// Numbers of the changes that a part stands for.
struct Changes {
    std::set<std::uint64_t> numbers;
    friend Changes around(const Changes& a, const Changes& b) {
        Changes both = a;
        both.numbers.insert(b.numbers.begin(), b.numbers.end());
        return both;
    }
};

using History = render_node::ChangeHistory<Changes>;
constexpr std::uint64_t kMost = History::kMostParts;

std::set<std::uint64_t> changesSince(const History& history, std::uint64_t revision) {
    std::set<std::uint64_t> all;
    for (const History::Part& part : history.since(revision)) {
        all.insert(part.where.numbers.begin(), part.where.numbers.end());
    }
    return all;
}

std::set<std::uint64_t> numbers(std::uint64_t first, std::uint64_t last) {
    std::set<std::uint64_t> all;
    for (std::uint64_t number = first; number <= last; ++number) {
        all.insert(number);
    }
    return all;
}

// A picture that was not drawn for long is drawn again wherever the sand has changed since. If the history has joined
// what the picture lacks with older changes, these are drawn again too.
TEST(ChangeHistory, LosesNoChangeHoweverManyThereAre) {
    History history;
    for (std::uint64_t last = 1; last <= 2 * kMost + 50; ++last) {
        history.add(last, {{last}});
        const std::uint64_t joined = last > kMost ? last - kMost + 1 : 0;  // number of the last change that was joined
        for (const std::uint64_t since : {std::uint64_t{0}, joined / 2, joined - std::min<std::uint64_t>(joined, 1),
                                          joined, std::min(joined + 1, last), (joined + last) / 2, last - 1, last}) {
            const std::uint64_t first = since < joined ? 1 : since + 1;
            ASSERT_EQ(changesSince(history, since), numbers(first, last)) << "since " << since << " of " << last;
        }
        ASSERT_LE(history.since(0).size(), kMost) << "the list must not grow without bound";
    }
}

TEST(ChangeHistory, GivesAllPartsOfARevision) {
    History history;
    for (std::uint64_t number = 1; number <= 3 * kMost; ++number) {
        history.add((number + 9) / 10, {{number}});  // ten changes in each revision
    }
    const std::uint64_t last = (3 * kMost + 9) / 10;
    EXPECT_TRUE(history.since(last).empty());
    EXPECT_EQ(changesSince(history, last - 1), numbers(10 * (last - 1) + 1, 3 * kMost));
    EXPECT_EQ(changesSince(history, last - 2), numbers(10 * (last - 2) + 1, 3 * kMost));
    EXPECT_EQ(changesSince(history, 0), numbers(1, 3 * kMost));
    EXPECT_EQ(history.since(0).front().revision, history.since(0)[1].revision)
        << "a joined part has the revision of its latest change";
}

TEST(ChangeHistory, JoinsBoxesOfATin) {
    const shapes::Box both = around(shapes::Box{{1, 2, 3}, {4, 5, 6}}, {{0, 3, 2}, {3, 7, 8}});
    EXPECT_EQ(both.low, glm::dvec3(0, 2, 2));
    EXPECT_EQ(both.high, glm::dvec3(4, 7, 8));
}

TEST(ChangeHistory, JoinsVerticesAndHeightsOfAGrid) {
    const render_node::ChangedVertices low{{10, 20, 30, 40}, {1, 2}}, high{{5, 25, 20, 60}, {1.5F, 3}};
    for (const render_node::ChangedVertices& both : {around(low, high), around(high, low)}) {
        EXPECT_EQ(both.vertices, (sand::CellRect{5, 20, 30, 60}));
        EXPECT_EQ(both.heights.lowest, 1);
        EXPECT_EQ(both.heights.highest, 3);
    }
}

}  // namespace
}  // namespace history
