// SPDX-License-Identifier: Apache-2.0
// Presses whose sand no cell can take. The level sand of the tests is a few cells below the largest height.
#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "sand/replica.hpp"
#include "tests/support/sand/high_sand.hpp"
#include "tests/support/sand/relaxing.hpp"
#include "tests/support/sand/sand_of.hpp"

namespace {

using samples::aboveHighSand;
using samples::highScene;
using samples::kHighLevel;
using samples::kHighSide;
using sand::kProbePerCell;
using sand::Replica;

/// Presses once, with the centre of the tool two cells above the level.
bool isRefused(double toolCells, sand::ToolKind kind = sand::ToolKind::sphere) {
    Replica replica(highScene(toolCells, kind));
    replica.apply({.number = 1, .engaged = true, .path = {aboveHighSand(2)}});
    return replica.refusedPress();
}

/// Presses the tool of a scene into `field`, so many probe units higher than in isRefused(). Returns whether it was
/// refused.
bool pressRaised(const scene::Scene& scene, int by, sand::HeightField& field) {
    sand::ProbePoint at = aboveHighSand(2);
    at.z += by;
    const sand::grid::Displacement tool(scene.rules.tuning.tool);
    return tool.drag(field, sand::Rim::closed, scene.ground.get(), at, at).refused > 0;
}

/// Returns the depth of the deepest cell below the level [cell].
double depthOf(const Replica& replica) {
    return (kHighLevel - replica.surface().heights().lowest) / sand::kUnitsPerCell;
}

TEST(RefusedPress, DigsAsDeepAsItsSandFitsAndIsCountedOnceAStep) {
    const scene::Scene scene = highScene(10);
    Replica replica(scene);
    replica.apply({.number = 1, .engaged = true, .path = {aboveHighSand(2)}});
    EXPECT_TRUE(replica.refusedPress());
    EXPECT_EQ(replica.volume(), scene.terrain.volume());
    EXPECT_GT(depthOf(replica), 0.5);
    EXPECT_LT(depthOf(replica), 8);
    replica.apply({.number = 2, .engaged = true, .path = {aboveHighSand(2, 34), aboveHighSand(2, 38)}});
    EXPECT_TRUE(replica.refusedPress());
    EXPECT_GT(replica.surface().refusedPresses().count, 2) << "each sub-step was refused";
    replica.apply({.number = 3, .engaged = true});  // the tool does not move
    EXPECT_FALSE(replica.refusedPress());
}

TEST(RefusedPress, DigsAsTheLowestToolWhosePressFits) {
    const scene::Scene scene = highScene(10);
    sand::HeightField refused = scene.terrain, higher = scene.terrain;
    EXPECT_TRUE(pressRaised(scene, 0, refused));
    int by = 1;
    for (; pressRaised(scene, by, higher); ++by) {
        ASSERT_TRUE(sameHeights(higher, refused)) << "each such tool digs as deep";
        higher = scene.terrain;
    }
    EXPECT_GT(by, 100) << "the tool is several cells too deep";
    EXPECT_TRUE(sameHeights(higher, refused));
}

// A search takes as long as 25 presses.
TEST(RefusedPress, PassesThroughTheSandAfterTheMostSearches) {
    const scene::Scene scene = highScene(10);
    const sand::grid::Displacement tool(scene.rules.tuning.tool);
    const auto drag = [&](sand::HeightField& field, std::int64_t mostSearches) {
        return tool.drag(field, sand::Rim::closed, nullptr, aboveHighSand(2, 34), aboveHighSand(2, 38), false,
                         mostSearches);
    };
    sand::HeightField all = scene.terrain, none = scene.terrain, one = scene.terrain;
    const auto searched = drag(all, INT64_MAX);
    EXPECT_EQ(searched.searches, 4) << "a sub-step is a cell long";
    EXPECT_EQ(drag(none, 0).searches, 0);
    EXPECT_TRUE(sameHeights(none, scene.terrain));
    EXPECT_EQ(drag(one, 1).searches, 1);
    EXPECT_FALSE(sameHeights(one, scene.terrain));
    EXPECT_FALSE(sameHeights(one, all));
    EXPECT_EQ(one.volume(), scene.terrain.volume());
}

TEST(RefusedPress, TellsTheLargestRadiusOfTheShapeThatFits) {
    using enum sand::ToolKind;
    for (const auto& [kind, cells] : {std::pair(sphere, 10), {ellipsoid, 24}}) {
        Replica replica(highScene(cells, kind));
        EXPECT_EQ(replica.firstRefusedPress(), std::nullopt);
        replica.apply({.number = 1, .engaged = true, .path = {aboveHighSand(2)}});
        ASSERT_TRUE(replica.refusedPress());
        const sand::RefusedPress first = replica.firstRefusedPress().value();
        EXPECT_EQ(first.tool.radius, cells * kProbePerCell);
        const int largest = first.largest.value() / kProbePerCell;
        EXPECT_GT(largest, 2) << "such a tool hovers";
        EXPECT_FALSE(isRefused(largest, kind)) << largest;
        EXPECT_TRUE(isRefused(largest + 1, kind)) << largest;
        const Replica copy = replica;
        EXPECT_EQ(copy.firstRefusedPress().value().largest, first.largest);
    }
}

/// The state does not contain the refused press: a replica that has computed a radius equals one that is given the
/// sand.
TEST(RefusedPress, IsNoPartOfTheState) {
    const scene::Scene scene = highScene(10);
    Replica replica(scene), other(scene);
    replica.apply({.number = 1, .engaged = true, .path = {aboveHighSand(2)}});
    other.decodeState(replica.encodeState());
    EXPECT_EQ(other.stateHash(), replica.stateHash());
    EXPECT_EQ(other.encodeState(), replica.encodeState());
    EXPECT_FALSE(other.refusedPress());
    EXPECT_EQ(other.firstRefusedPress(), std::nullopt);
}

/// Beside a wall the surroundings are divided, and each part takes its own sand.
TEST(RefusedPress, IsSeenBesideAWall) {
    scene::Scene scene = highScene(10);
    auto ground = std::make_shared<sand::Ground>(kHighSide, kHighSide);
    for (int row = 0; row < kHighSide; ++row) {
        ground->setWall(kHighSide / 2, row);
    }
    scene.ground = ground;
    Replica replica(scene);
    replica.apply({.number = 1, .engaged = true, .path = {aboveHighSand(2)}});
    EXPECT_TRUE(replica.refusedPress());
    EXPECT_LT(replica.firstRefusedPress().value().largest.value(), 10 * kProbePerCell);
    EXPECT_GT(depthOf(replica), 0.5);
    EXPECT_EQ(replica.volume(), scene.terrain.volume());
}

/// Cells that have no room for their share take none. The others take theirs.
TEST(RefusedPress, IsNoneIfOtherCellsHaveRoom) {
    scene::Scene scene = highScene(14);
    for (int row = 0; row < kHighSide / 2; ++row) {
        for (int column = 0; column < kHighSide; ++column) {
            scene.terrain.setHeight(column, row, kHighLevel - 100 * sand::kUnitsPerCell);
        }
    }
    Replica replica(scene);
    replica.apply({.number = 1, .engaged = true, .path = {aboveHighSand(2)}});
    EXPECT_FALSE(replica.refusedPress());
    const sand::HeightField after = samples::fieldOf(replica);
    EXPECT_EQ(replica.volume(), Replica(scene).volume());
    EXPECT_LT(after.height(kHighSide / 2, kHighSide / 2 + 2), kHighLevel) << "the tool has taken sand there";
    EXPECT_GT(after.height(kHighSide / 2, kHighSide / 2 - 16), kHighLevel - 100 * sand::kUnitsPerCell);
}

TEST(RefusedPress, IsNoneThatFits) {
    EXPECT_FALSE(isRefused(4));
    EXPECT_FALSE(isRefused(4, sand::ToolKind::footprint));
}

}  // namespace
