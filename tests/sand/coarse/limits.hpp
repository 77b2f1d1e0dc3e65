// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "sand/grid/displacement.hpp"
#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/sand/sand_of.hpp"

/// Checks of the limits that a coarse phase must keep.
namespace coarse {

/// Surroundings of the sand. Ground and tool may be null.
struct Limits {
    sand::CellRect changed;  // cells that may change
    sand::Rim rim;
    const sand::Ground* ground;
    const sand::grid::Obstacle* tool;
};

/// Returns the lowest and the highest height of the field [unit].
inline std::pair<std::int32_t, std::int32_t> rangeOf(const sand::HeightField& field) {
    std::int32_t low = sand::kMaxHeight, high = -sand::kMaxHeight;
    for (int y = 0; y < field.rows(); ++y) {
        low = std::min(low, *std::min_element(field.row(y), field.row(y) + field.columns()));
        high = std::max(high, *std::max_element(field.row(y), field.row(y) + field.columns()));
    }
    return {low, high};
}

/// Expects that no cell has left the range of the field, its rock, or the underside of the tool.
inline void expectWithinLimits(const sand::HeightField& before, const sand::HeightField& after, const Limits& limits) {
    const auto [lowest, highest] = rangeOf(before);
    for (int y = 0; y < before.rows(); ++y) {
        for (int x = 0; x < before.columns(); ++x) {
            const std::int32_t was = before.height(x, y), is = after.height(x, y);
            if (is == was) {
                continue;
            }
            ASSERT_FALSE(limits.changed.clippedTo({x, y, x + 1, y + 1}).empty()) << x << ", " << y;
            ASSERT_TRUE(is >= lowest || limits.rim == sand::Rim::open);  // sand has fallen over it
            ASSERT_LE(is, highest);
            ASSERT_FALSE(limits.ground != nullptr && limits.ground->isWall(x, y)) << x << ", " << y;
            ASSERT_GE(is, limits.ground != nullptr ? limits.ground->bedrock(x, y) : -sand::kMaxHeight)
                << x << ", " << y;
            if (limits.tool != nullptr && !limits.tool->cells.clippedTo({x, y, x + 1, y + 1}).empty()) {
                ASSERT_LE(is, std::max(was, limits.tool->row(y)[x - limits.tool->cells.x0])) << x << ", " << y;
            }
        }
    }
}

/// Applies `step`, and expects that it is not left out, and that its coarse phase keeps its limits. Returns whether the
/// phase has moved sand.
inline bool applyWithinLimits(sand::Replica& sand, const scene::Scene& scene, sand::Step step) {
    sand::HeightField before(1, 1, 1.0);
    step.number = sand.stepNumber() + 1;
    bool phase = false, moved = false;
    sand.apply(step, [&](sand::StepPart part) {
        const sand::HeightField& field = samples::fieldOf(sand);
        if (part == sand::StepPart::movement) {
            before = field;
            return;
        }
        phase = true;
        moved = !sameHeights(before, field);
        const sand::grid::Obstacle tool = sand::grid::Displacement(sand.tool()).obstacle(before, sand.probe());
        expectWithinLimits(before, field,
                           {field.bounds(), scene.rules.rim, scene.ground.get(),
                            sand.engaged() && !tool.cells.empty() ? &tool : nullptr});
    });
    EXPECT_TRUE(phase) << "the step has no coarse phase, so that the test shows nothing";
    EXPECT_EQ(sand.leftOut(), "");
    EXPECT_EQ(sand.volume() + sand.outflow(), scene.terrain.volume());
    EXPECT_TRUE(scene.rules.rim == sand::Rim::open || sand.outflow() == 0);
    return moved;
}

}  // namespace coarse
