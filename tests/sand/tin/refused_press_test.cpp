// SPDX-License-Identifier: Apache-2.0
// Presses whose sand no vertex can take. The level sand of the tests is a few cells below the largest height.
#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "sand/replica.hpp"
#include "sand/tin/refine/start_maker.hpp"
#include "tests/sand/tin/tool_fixture.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace tin_refused_press {
namespace {

using namespace tin_samples;
using sand::Replica;

constexpr int kSide = 24;          // [cell]
constexpr int kBelow = 2;          // [cell], of the sand below the largest height
constexpr double kToolRadius = 6;  // [cell]

/// Returns a TIN of level sand. With `divided`, walls from rim to rim leave three strips, which are three parts.
scene::Scene highScene(bool divided) {
    scene::Scene scene = samples::flatScene(kSide, kSide, kToolRadius);
    sand::Ground walls(kSide, kSide);
    for (int row = 0; row < kSide; ++row) {
        for (int column = 0; column < kSide; ++column) {
            scene.terrain.setHeight(column, row, sand::kMaxHeight - kBelow * sand::kUnitsPerCell);
            if (divided && (column < 7 || column == 9 || column == 14 || column > 16)) {
                walls.setWall(column, row);
            }
        }
    }
    auto start =
        sand::tin::follow(scene.terrain, divided ? &walls : nullptr, {.widest = sand::kProbePerCell, .maxError = 0})
            .start;
    start.settings.spacing = sand::kProbePerCell;
    scene.rules.tin = start.digest();
    scene.tin = std::make_shared<const sand::tin::TinStart>(std::move(start));
    scene.terrain = sand::HeightField(1, 1, 1);
    return scene;
}

sand::Step pressAt(std::uint64_t number, double column) {
    constexpr double kMost = static_cast<double>(sand::kMaxHeight) / sand::kUnitsPerCell;  // [cell]
    return {.number = number, .engaged = true, .path = {probeAt(column, kSide / 2.0, kMost)}};
}

TEST(TinRefusedPress, IsCountedOnceAlsoIfNoPartBesideAHoleCanTakeItsSand) {
    for (const bool divided : {false, true}) {
        Replica replica(highScene(divided));
        replica.apply(pressAt(1, kSide / 2.0));
        EXPECT_TRUE(replica.refusedPress());
        EXPECT_EQ(replica.surface().refusedPresses().count, 1) << (divided ? "in three parts" : "in one part");
        EXPECT_EQ(replica.firstRefusedPress().value().tool.radius, kToolRadius * sand::kProbePerCell);
        EXPECT_EQ(replica.firstRefusedPress().value().largest, std::nullopt);
    }
}

TEST(TinRefusedPress, IsKnownToACopyOfTheSand) {
    Replica replica(highScene(false));
    replica.apply(pressAt(1, kSide / 2.0));
    Replica copy = replica;
    EXPECT_TRUE(copy.refusedPress());
    EXPECT_TRUE(copy.firstRefusedPress().has_value());
    EXPECT_EQ(copy.surface().refusedPresses().count, 1);
    copy.apply({.number = 2, .engaged = true});
    EXPECT_FALSE(copy.refusedPress()) << "it counts from there";
    EXPECT_EQ(copy.surface().refusedPresses().count, 1);
}

}  // namespace
}  // namespace tin_refused_press
