// SPDX-License-Identifier: Apache-2.0
// One level of a coarse phase, on random worlds and at borders.
#include "sand/grid/coarse_level.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "host/worker_pool.hpp"
#include "tests/sand/coarse/limits.hpp"
#include "tests/sand/grid/random_worlds.hpp"

namespace {

using sand::CellRect;
using sand::grid::CoarseLevel;
using sand::grid::Obstacle;
using worlds::World;

CellRect randomPatch(World& world) {
    const int x = world.below(world.rules.columns), y = world.below(world.rules.rows);
    return {x - world.below(9), y - world.below(9), x + 1 + world.below(60), y + 1 + world.below(60)};
}

TEST(CoarseLevel, KeepsVolumeRangeRockWallsAndTheToolOnRandomWorlds) {
    int moved = 0, outflows = 0, tools = 0;
    for (unsigned seed = 0; seed < 1100; ++seed) {
        World world(seed, 120, 90, seed % 4 == 0);
        const std::optional<Obstacle> tool = world.tool();
        const Obstacle* const obstacle = tool ? &*tool : nullptr;
        const sand::HeightField before = world.field;
        const CoarseLevel::Site site{world.field, world.rules, world.ground.get(), obstacle, {}};
        const int side = 2 << world.below(4);
        const CoarseLevel::Result result = CoarseLevel(site, randomPatch(world), side).sweep(1 + world.below(30));
        ASSERT_EQ(world.field.volume() + result.outflow, before.volume()) << world.text() << ", seed " << seed;
        ASSERT_TRUE(world.rules.rim == sand::Rim::open || result.outflow == 0) << seed;
        coarse::expectWithinLimits(before, world.field,
                                   {result.changed, world.rules.rim, world.ground.get(), obstacle});
        if (testing::Test::HasFatalFailure()) {
            FAIL() << world.text() << ", seed " << seed << ", coarse cells of " << side;
        }
        moved += result.changed.empty() ? 0 : 1;
        outflows += result.outflow != 0 ? 1 : 0;
        tools += obstacle != nullptr && !result.changed.clippedTo(obstacle->cells).empty() ? 1 : 0;
    }
    EXPECT_GT(moved, 300);
    EXPECT_GT(outflows, 50);
    EXPECT_GT(tools, 50);
}

TEST(CoarseLevel, DependsOnNoThreadBlockOrCodePath) {
    const host::WorkerPool pool(3);
    for (unsigned seed = 0; seed < 40; ++seed) {
        World world(seed, 120, 90, false), other(seed, 120, 90, false);
        const CoarseLevel::Site site{world.field, world.rules, world.ground.get(), nullptr, {}};
        const CoarseLevel::Site shared{other.field,
                                       other.rules,
                                       other.ground.get(),
                                       nullptr,
                                       {.blockSize = 13, .path = base::CodePath::baseline, .executor = pool.lend()}};
        const CellRect all = world.field.bounds();
        (void)CoarseLevel(site, all, 4).sweep(20);
        (void)CoarseLevel(shared, all, 4).sweep(20);
        ASSERT_TRUE(sameHeights(world.field, other.field)) << "seed " << seed;
    }
}

/// Returns a plane that rises by `east` and `north` a cell [talus].
sand::HeightField plane(const sand::Rules& rules, double east, double north) {
    sand::HeightField field(rules.columns, rules.rows, 1.0);
    for (int y = 0; y < rules.rows; ++y) {
        for (int x = 0; x < rules.columns; ++x) {
            field.setHeight(x, y,
                            static_cast<std::int32_t>(std::lround(rules.tuning.threshold * (east * x + north * y))));
        }
    }
    return field;
}

TEST(CoarseLevel, LeavesSandAloneThatIsNoSteeperThanTheTalus) {
    sand::Rules rules = samples::rulesFor(sand::HeightField(101, 77, 1.0));
    for (const std::int32_t threshold : {0, 1, 1000, 44204, sand::kUnitsPerCell}) {
        rules.tuning.threshold = rules.tuning.startThreshold = threshold;
        for (int degrees = 0; degrees < 360; degrees += 15) {
            const double turned = degrees * std::numbers::pi / 180;
            sand::HeightField field = plane(rules, std::cos(turned), std::sin(turned));
            const sand::HeightField before = field;
            for (const int side : {2, 4, 8}) {
                const CoarseLevel::Site site{field, rules, nullptr, nullptr, {}};
                EXPECT_TRUE(CoarseLevel(site, {3, 5, 90, 70}, side).sweep(30).changed.empty())
                    << threshold << ", " << degrees << " degrees, " << side;
            }
            ASSERT_TRUE(sameHeights(field, before)) << threshold << ", " << degrees << " degrees";
        }
    }
}

// The mean of sand and rock would be too high, so that sand at the foot of a cliff would slide away.
TEST(CoarseLevel, LeavesStableSandAtTheFootOfACliffAlone) {
    for (const sand::Rim rim : {sand::Rim::closed, sand::Rim::open}) {
        for (int edge = 40; edge < 48; ++edge) {
            sand::HeightField field(80, 24, 1.0);
            sand::Ground ground(80, 24);
            for (int y = 0; y < 24; ++y) {
                for (int x = 0; x < 80; ++x) {
                    const bool cliff = x >= edge && x < edge + 9;
                    field.setHeight(x, y, cliff ? 30 * sand::kUnitsPerCell : 0);
                    ground.setBedrock(x, y, (cliff ? 30 : -20) * sand::kUnitsPerCell);
                }
            }
            field.setHeight(8, 8, -15 * sand::kUnitsPerCell);  // so that other sand may go as deep
            const sand::HeightField before = field;
            sand::Rules rules = samples::rulesFor(field);
            rules.rim = rim;
            const CoarseLevel::Result result =
                CoarseLevel({field, rules, &ground, nullptr, {}}, {0, 0, 80, 24}, 4).sweep(30);
            EXPECT_TRUE(result.changed.empty()) << "a cliff from column " << edge;
            EXPECT_TRUE(sameHeights(field, before));
        }
    }
}

TEST(CoarseLevel, LetsSandBetweenTalusAndStartRest) {
    sand::Rules rules = samples::rulesFor(sand::HeightField(64, 64, 1.0));
    rules.tuning.threshold = 40000;
    rules.tuning.startThreshold = 48000;
    for (const auto& [slope, moves] : {std::pair(1.1, false), {1.19, false}, {1.25, true}}) {
        sand::HeightField field = plane(rules, slope, 0);
        const CoarseLevel::Site site{field, rules, nullptr, nullptr, {}};
        EXPECT_EQ(CoarseLevel(site, field.bounds(), 4).sweep(10).changed.empty(), !moves) << slope;
    }
}

/// A heap beside each rim of a field whose sides the coarse cells do not divide.
sand::HeightField heapAt(int columns, int rows, int x, int y, bool mirrored) {
    sand::HeightField field(columns, rows, 1.0);
    for (int row = std::max(y - 6, 0); row < std::min(y + 6, rows); ++row) {
        for (int column = std::max(x - 6, 0); column < std::min(x + 6, columns); ++column) {
            field.setHeight(mirrored ? columns - 1 - column : column, row, 30 * sand::kUnitsPerCell);
        }
    }
    return field;
}

TEST(CoarseLevel, ReachesEachRimOnASideThatItDoesNotDivide) {
    for (const sand::Rim rim : {sand::Rim::closed, sand::Rim::open}) {
        sand::HeightField west = heapAt(101, 63, 3, 31, false), east = heapAt(101, 63, 3, 31, true);
        sand::Rules rules = samples::rulesFor(west);
        rules.rim = rim;
        const auto run = [&rules](sand::HeightField& field, const CellRect& patch) {
            return CoarseLevel({field, rules, nullptr, nullptr, {}}, patch, 4).sweep(20);
        };
        const CoarseLevel::Result atWest = run(west, {0, 10, 40, 50}), atEast = run(east, {61, 10, 101, 50});
        EXPECT_EQ(atWest.changed.x0, 0);
        EXPECT_EQ(atEast.changed.x1, 101);
        EXPECT_EQ(atWest.outflow, atEast.outflow);
        EXPECT_EQ(atWest.outflow > 0, rim == sand::Rim::open);
        for (int row = 0; row < 63; ++row) {
            for (int column = 0; column < 101; column += 4) {
                std::int64_t mean = 0, mirrored = 0;
                for (int i = column; i < std::min(column + 4, 101); ++i) {
                    mean += west.height(i, row);
                    mirrored += east.height(100 - i, row);
                }
                ASSERT_LE(std::abs(mean - mirrored), 16) << column << ", " << row;
            }
        }
    }
}

/// Returns a tool that lies on sand of height 0, with a gap of one cell in the column `gap`.
Obstacle toolWithGap(const CellRect& cells, int gap) {
    Obstacle tool;
    tool.cells = cells;
    const int padded = cells.y1 - cells.y0 + 2 * Obstacle::kRowsBeside;
    tool.underside.assign(static_cast<std::size_t>(tool.stride()) * static_cast<std::size_t>(padded), Obstacle::kFree);
    for (int y = cells.y0; y < cells.y1; ++y) {
        const auto row = static_cast<std::size_t>(tool.row(y) - tool.underside.data());
        for (int x = cells.x0; x < cells.x1; ++x) {
            tool.underside[row + static_cast<std::size_t>(x - cells.x0)] = x == gap ? Obstacle::kFree : 0;
        }
    }
    tool.findReached();
    return tool;
}

// A coarse cell is as high as its mean. So sand in a gap between toes could rise far above the sand beside the foot.
TEST(CoarseLevel, SandInAGapOfTheToolRisesNoHigherThanTheSandAround) {
    constexpr int kGap = 9;
    for (const int side : {2, 4, 8}) {
        sand::HeightField field(64, 64, 1.0);
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 8; ++x) {
                field.setHeight(x, y, 20 * sand::kUnitsPerCell);
            }
            field.setHeight(60, y, 500 * sand::kUnitsPerCell);  // far away, so that the patch is much higher
        }
        const Obstacle tool = toolWithGap({8, 0, 40, 64}, kGap);
        const sand::Rules rules = samples::rulesFor(field);
        (void)CoarseLevel({field, rules, nullptr, &tool, {}}, field.bounds(), side).sweep(40);
        std::int32_t highest = 0;
        for (int y = 0; y < 64; ++y) {
            highest = std::max(highest, field.height(kGap, y));
        }
        EXPECT_LE(highest, 20 * sand::kUnitsPerCell) << "coarse cells of " << side;
        EXPECT_GT(highest, 0) << "coarse cells of " << side;
    }
}

TEST(CoarseLevel, ClosesThePatchInsideAFieldWithOpenRims) {
    sand::HeightField field = heapAt(100, 100, 50, 50, false);
    sand::Rules rules = samples::rulesFor(field);
    rules.rim = sand::Rim::open;
    const CoarseLevel::Result result =
        CoarseLevel({field, rules, nullptr, nullptr, {}}, {40, 40, 60, 60}, 4).sweep(200);
    EXPECT_EQ(result.outflow, 0);
    EXPECT_EQ(result.changed, (CellRect{40, 40, 60, 60}));
}

TEST(CoarseLevel, DoesNothingInAPatchThatIsSmallerThanACell) {
    for (const auto& [columns, rows] : {std::pair(1, 1), {3, 200}, {7, 7}}) {
        sand::HeightField field(columns, rows, 1.0);
        field.setHeight(0, 0, sand::kMaxHeight);
        const sand::Rules rules = samples::rulesFor(field);
        const CoarseLevel::Site site{field, rules, nullptr, nullptr, {}};
        EXPECT_TRUE(CoarseLevel(site, field.bounds(), 8).sweep(10).changed.empty()) << columns << " x " << rows;
    }
}

}  // namespace
