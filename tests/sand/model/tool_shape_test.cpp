// SPDX-License-Identifier: Apache-2.0
// Tools of every shape: their imprints, and that all directions are equal.
#include "sand/model/tool_shape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "sand/grid/displacement.hpp"
#include "sand/grid/dunes.hpp"
#include "sand/model/tuning.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/borders/tool_kinds.hpp"
#include "tests/support/sand/relaxing.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using sand::Heading;
using sand::kProbePerCell;
using sand::kUnitsPerCell;
using sand::ProbePoint;
using sand::Rim;
using sand::Tool;
using sand::ToolKind;
using sand::grid::Displacement;
using enum sand::ToolKind;

constexpr auto kEvery = support::everyTool();

std::int32_t probes(double cells) { return static_cast<std::int32_t>(std::floor(cells * kProbePerCell + 0.5)); }

Tool toolOf(ToolKind kind, double radius /* [cell] */, const Heading& heading = {}) {
    return {kind, probes(radius), sand::isRound(kind) ? 0 : probes(radius * sand::usualWidth(kind)), heading};
}

Heading heading(double degrees, bool mirrored = false) { return *sand::headingOf(degrees, mirrored); }

/// Returns the depth of a tool at a place [radius], computed from the definitions in the widest floats. The place is in
/// half lengths and half widths. Returns nullopt beside the tool.
std::optional<long double> depthBelow(ToolKind kind, long double along, long double across) {
    const long double square = along * along + across * across;
    if (kind == sphere || kind == ellipsoid) {
        return square < 1 ? std::optional(std::sqrt(1 - square)) : std::nullopt;
    }
    if (kind == rectangle) {
        return std::abs(along) < 1 && std::abs(across) < 1 ? std::optional(1.0L) : std::nullopt;
    }
    if (sand::solePieces(kind).empty()) {
        return square < 1 ? std::optional(1.0L) : std::nullopt;
    }
    std::optional<long double> deepest;
    for (const sand::SolePiece& piece : sand::solePieces(kind)) {
        const long double x = (along - piece.along) / piece.halfLength, y = (across - piece.across) / piece.halfWidth;
        if (x * x + y * y < 1) {
            deepest = std::max(deepest.value_or(0), 1 - piece.lift - piece.bulge * (x * x + y * y));
        }
    }
    return deepest;
}

/// Returns the depth at (x, y), turned into the tool's own axes by the quantised heading.
std::optional<long double> depthAt(const Tool& tool, long double x, long double y) {
    const Heading& heading = tool.heading;
    const long double length = std::hypot(static_cast<long double>(heading.x), static_cast<long double>(heading.y));
    const long double along = (x * heading.x + y * heading.y) / length;
    const long double across = (y * heading.x - x * heading.y) / length * (heading.mirrored ? -1 : 1);
    const long double width = sand::isRound(tool.kind) ? tool.radius : tool.halfWidth;
    return depthBelow(tool.kind, along / tool.radius, across / width);
}

TEST(ToolShape, PrintsItsUndersideAndNothingElse) {
    for (const ToolKind kind : kEvery) {
        for (const Heading& turn : {heading(0), heading(90), heading(30), heading(217.3, true)}) {
            sand::HeightField field(90, 80, 1.0);
            const Tool tool = toolOf(kind, 24, turn);
            const ProbePoint probe{probes(44.3), probes(39.6), probes(20)};
            Displacement(tool).drag(field, Rim::closed, nullptr, probe, probe);
            int below = 0;
            for (int row = 0; row < field.rows(); ++row) {
                for (int column = 0; column < field.columns(); ++column) {
                    const long double x = (column + 0.5L) * kProbePerCell - probe.x,
                                      y = (row + 0.5L) * kProbePerCell - probe.y;
                    const auto depth = depthAt(tool, x, y);
                    if (!depth) {
                        EXPECT_GE(field.height(column, row), 0) << base::nameOf(kind) << " beside";
                        continue;
                    }
                    const long double underside = (probe.z - *depth * tool.radius) * kUnitsPerCell / kProbePerCell;
                    const long double expected = std::min(0.0L, underside);
                    ASSERT_NEAR(static_cast<double>(field.height(column, row) - expected), 0, 1)
                        << base::nameOf(kind) << " at " << column << ", " << row;
                    below += underside < 0 ? 1 : 0;
                }
            }
            EXPECT_GT(below, 250) << base::nameOf(kind);
            // A tool's lowest point is one radius below its centre. Few cells below a round tool are that low.
            const std::int32_t lowest = samples::extremesOf(field).lowest;
            EXPECT_GE(lowest, -4 * kUnitsPerCell) << base::nameOf(kind);
            EXPECT_LE(lowest, -4 * kUnitsPerCell + kUnitsPerCell / 20) << base::nameOf(kind);
        }
    }
}

/// One of the eight ways to put a field onto a grid, as in symmetry_test.cpp. Bit 0 mirrors east and west, bit 1
/// mirrors north and south, and bit 2 then exchanges columns and rows.
struct Way {
    unsigned bits;
    int columns, rows;

    [[nodiscard]] ProbePoint of(ProbePoint probe) const {
        const std::int32_t x = (bits & 1) != 0 ? columns * kProbePerCell - probe.x : probe.x;
        const std::int32_t y = (bits & 2) != 0 ? rows * kProbePerCell - probe.y : probe.y;
        return (bits & 4) != 0 ? ProbePoint{y, x, probe.z} : ProbePoint{x, y, probe.z};
    }
    [[nodiscard]] Heading of(Heading turn) const {
        for (const unsigned bit : {1U, 2U, 4U}) {
            turn.mirrored = turn.mirrored != ((bits & bit) != 0);
        }
        turn.x = static_cast<std::int16_t>((bits & 1) != 0 ? -turn.x : turn.x);
        turn.y = static_cast<std::int16_t>((bits & 2) != 0 ? -turn.y : turn.y);
        if ((bits & 4) != 0) {
            std::swap(turn.x, turn.y);
        }
        return turn;
    }
    [[nodiscard]] sand::HeightField of(const sand::HeightField& field) const {
        const bool swapped = (bits & 4) != 0;
        sand::HeightField result(swapped ? rows : columns, swapped ? columns : rows, 1.0);
        for (int y = 0; y < rows; ++y) {
            for (int x = 0; x < columns; ++x) {
                const int toX = (bits & 1) != 0 ? columns - 1 - x : x, toY = (bits & 2) != 0 ? rows - 1 - y : y;
                result.setHeight(swapped ? toY : toX, swapped ? toX : toY, field.height(x, y));
            }
        }
        return result;
    }
};

/// Returns a scene's sand after a press, a drag and a turn of its tool, put onto the grid by `way`.
sand::HeightField dug(const scene::Scene& scene, const std::vector<ProbePoint>& path, double degrees, const Way& way) {
    sand::Replica replica(scene);
    for (std::uint64_t i = 1; i <= 12; ++i) {
        sand::Step step{.epoch = 1, .number = i, .engaged = true, .path = {}};
        step.heading = way.of(heading(degrees + (i > 6 ? 20 : 0)));
        if (i <= path.size()) {
            step.path = {way.of(path[i - 1])};
        }
        replica.apply(step);
    }
    return samples::fieldOf(replica);
}

// A quarter turn consists of an exchange and a mirroring. Round tools are left out, because they give their last units
// by rows.
TEST(ToolShape, TurnedOrMirroredItDoesTheSameTurnedOrMirrored) {
    std::mt19937 random(61);
    // The release build compares the values. With sanitizers, two ways are enough to run all of the code.
    const std::vector<unsigned> ways =
        samples::kSanitized ? std::vector{3U, 6U} : std::vector{1U, 2U, 3U, 4U, 5U, 6U, 7U};
    for (const ToolKind kind : support::longTools()) {
        for (const double degrees : {0.0, 33.0, 90.0, -140.0}) {
            scene::Scene scene = samples::flatScene(75, 52, 0);
            scene.terrain = samples::randomField(75, 52, 1 << 18, random);
            scene.rules.tuning.tool = toolOf(kind, 11);
            const std::vector<ProbePoint> path{{probes(20.2), probes(24.7), probes(9)},
                                               {probes(43.9), probes(31.4), probes(7)},
                                               {probes(41.0), probes(3.3), probes(8)}};
            const sand::HeightField first = dug(scene, path, degrees, Way{0, 75, 52});
            ASSERT_FALSE(sameHeights(first, scene.terrain));
            for (const unsigned bits : ways) {
                const Way way{bits, 75, 52};
                scene::Scene image = scene;
                image.terrain = way.of(scene.terrain);
                image.rules.columns = image.terrain.columns();
                image.rules.rows = image.terrain.rows();
                ASSERT_TRUE(sameHeights(way.of(first), dug(image, path, degrees, way)))
                    << base::nameOf(kind) << " by " << degrees << " degrees, way " << bits;
            }
        }
    }
}

TEST(ToolShape, AHeadingIsQuantisedOnceAndExactAlongTheAxes) {
    EXPECT_EQ(heading(0), (Heading{Heading::kLength, 0, false}));
    EXPECT_EQ(heading(90), (Heading{0, Heading::kLength, false}));
    EXPECT_EQ(heading(-180, true), (Heading{-Heading::kLength, 0, true}));
    EXPECT_EQ(heading(3690), heading(90));
    for (double degrees = -179.9; degrees < 180; degrees += 0.7) {
        const Heading turn = heading(degrees);
        EXPECT_TRUE(turn.valid()) << degrees;
        EXPECT_NEAR(sand::degreesOf(turn), degrees, 0.0045) << "more than a cell at the end of a tool of 12,000";
    }
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        EXPECT_FALSE(sand::headingOf(bad).has_value());
    }
    EXPECT_FALSE((Heading{100, 100, false}).valid());
}

/// Returns the volume above the starting level on one side of a line through the tool's centre.
std::int64_t raisedWhere(const sand::HeightField& field, const auto& side) {
    std::int64_t sum = 0;
    for (int row = 0; row < field.rows(); ++row) {
        for (int column = 0; column < field.columns(); ++column) {
            sum += side(column + 0.5, row + 0.5) ? std::max(field.height(column, row), 0) : 0;
        }
    }
    return sum;
}

TEST(ToolShape, DraggedSidewaysItPushesToTheSideAhead) {
    for (const ToolKind kind : {rectangle, ellipse, footprint}) {
        sand::HeightField field(90, 90, 1.0);
        const Displacement tool(toolOf(kind, 16, heading(90)));  // the long side points east
        const ProbePoint from{probes(30), probes(45), probes(14)}, to{probes(50), probes(45), probes(14)};
        tool.drag(field, Rim::closed, nullptr, from, from);
        const std::int64_t imprint = raisedWhere(field, [](double, double) { return true; });
        tool.drag(field, Rim::closed, nullptr, from, to);
        const std::int64_t ahead = raisedWhere(field, [](double x, double) { return x > 50; });
        const std::int64_t all = raisedWhere(field, [](double, double) { return true; });
        EXPECT_GT(static_cast<double>(ahead), 0.65 * static_cast<double>(all - imprint))
            << base::nameOf(kind) << ": the rest of a foot goes out at heel and toes";
        EXPECT_GT(all, 2 * imprint);
    }
    // Along its length, the same blade cuts a furrow that is no wider than the blade.
    sand::HeightField field(120, 90, 1.0);
    const Displacement blade(toolOf(rectangle, 16));
    blade.drag(field, Rim::closed, nullptr, {probes(30), probes(45), probes(14)}, {probes(80), probes(45), probes(14)});
    for (int row = 0; row < 90; ++row) {
        EXPECT_EQ(field.height(60, row) < 0, std::abs(row + 0.5 - 45) < 8) << row;
    }
}

scene::Scene sceneWith(ToolKind kind, double radius, Rim rim = Rim::closed) {
    scene::Scene scene = samples::flatScene(45, 33, radius);
    sand::grid::makeDunes({.bed = 2, .height = 4, .length = 20, .seed = 3}, scene.terrain);
    scene.rules.rim = rim;
    scene.rules.tuning.tool.kind = kind;
    scene.rules.tuning.tool.halfWidth = toolOf(kind, radius).halfWidth;
    return scene;
}

TEST(ToolShape, EveryOneKeepsTheVolumeWhereverItIs) {
    for (const Rim rim : {Rim::closed, Rim::open}) {
        for (const ToolKind kind : kEvery) {
            for (const double radius : {0.3, 2.56, 9.0, 60.0, 150.0}) {
                const scene::Scene scene = sceneWith(kind, radius, rim);
                const std::int64_t before = scene.terrain.volume();
                std::mt19937 random(67);
                sand::Replica replica(scene);
                std::uint64_t number = 0;
                for (const auto& [x, y] : {std::pair{0, 0}, {45, 33}, {22, 0}, {20, 16}}) {
                    sand::Step step = samples::randomStep(++number, scene.rules, random);
                    step.engaged = true;
                    step.heading = heading(31.0 * static_cast<double>(number));
                    step.path = {{probes(x), probes(y), probes(radius)},
                                 {probes(x + 5), probes(y - 3), probes(radius)}};
                    replica.apply(step);
                    ASSERT_EQ(samples::fieldOf(replica).volume() + replica.outflow(), before)
                        << base::nameOf(kind) << " of " << radius << " at " << x << ", " << y;
                }
            }
        }
    }
}

TEST(ToolShape, OfNoRadiusItDigsNothing) {
    for (const ToolKind kind : kEvery) {
        scene::Scene scene = samples::flatScene(45, 33, 0);
        scene.rules.tuning.tool.kind = kind;
        sand::Replica replica(scene);
        replica.apply({1, 1, true, {{probes(5.5), probes(5.5), probes(-3)}, {probes(40), probes(30), probes(-3)}}});
        EXPECT_TRUE(sameHeights(samples::fieldOf(replica), scene.terrain)) << base::nameOf(kind);
    }
}

TEST(ToolShape, SwitchedTurnedAndDraggedAtRandomItKeepsTheVolumeAndTheStatesOfCopies) {
    for (const Rim rim : {Rim::closed, Rim::open}) {
        const scene::Scene scene = sceneWith(footprint, 7, rim);
        const std::int64_t before = scene.terrain.volume();
        sand::Replica replica(scene), copy(scene);
        std::mt19937 random(71);
        for (std::uint64_t i = 1; i <= 600; ++i) {
            const sand::Step step = samples::wildStep(i, scene.rules, random);
            replica.apply(step);
            ASSERT_EQ(samples::fieldOf(replica).volume() + replica.outflow(), before) << "step " << i;
            if (i == 300) {
                copy.decodeState(replica.encodeState());
            } else if (i > 300) {
                copy.apply(step);
                ASSERT_EQ(copy.stateHash(), replica.stateHash()) << "step " << i;
            }
        }
        EXPECT_EQ(copy.heading(), replica.heading());
    }
}

TEST(ToolShape, TurnedOnTheSpotItMakesRoomAndHeldStillItComesToRest) {
    for (const ToolKind kind : support::longTools()) {
        scene::Scene scene = samples::flatScene(60, 60, 12);
        scene.rules.tuning.tool = toolOf(kind, 12);
        sand::Replica replica(scene);
        replica.apply({1, 1, true, {{probes(30), probes(30), probes(9)}}});
        sand::Step turn{1, 2, true, {}};
        turn.heading = heading(90);
        replica.apply(turn);
        const sand::grid::Obstacle under =
            Displacement(replica.tool()).obstacle(samples::fieldOf(replica), replica.probe());
        for (int row = under.cells.y0; row < under.cells.y1; ++row) {
            for (int column = under.cells.x0; column < under.cells.x1; ++column) {
                ASSERT_LE(samples::fieldOf(replica).height(column, row), under.row(row)[column - under.cells.x0])
                    << base::nameOf(kind);
            }
        }
        for (int i = 0; i < 3000 && !replica.settled(); ++i) {
            replica.apply({1, replica.stepNumber() + 1, true, {}});
        }
        EXPECT_TRUE(replica.settled()) << base::nameOf(kind);
        EXPECT_EQ(samples::fieldOf(replica).volume(), 0);
    }
}

TEST(ToolShape, AnOperatorWhoChangesTheToolAloneLeavesAHandsHeading) {
    const scene::Scene scene = sceneWith(ellipse, 5);
    sand::Replica replica(scene);
    sand::Step turned{1, 1, false, {}};
    turned.heading = heading(40);
    replica.apply(turned);
    sand::Tuning tuning = scene.rules.tuning;
    tuning.tool.kind = footprint;
    replica.apply({1, 2, false, {}, sand::Edit::tuned(tuning)});
    EXPECT_EQ(replica.heading(), heading(40));
    tuning.tool.heading = heading(70);
    replica.apply({1, 3, false, {}, sand::Edit::tuned(tuning)});
    EXPECT_EQ(replica.heading(), heading(70)) << "the operator turned it";
}

// Undersides of a row equal those of single cells, with either instruction set. A single cell computes one root at a
// time.
TEST(ToolShape, ARowOfUndersidesIsEachOfThem) {
    std::mt19937 random(7);
    const auto anyOf = [&random](std::int64_t least, std::int64_t most) {
        return std::uniform_int_distribution<std::int64_t>(least, most)(random);
    };
    for (int i = 0; i < 3000; ++i) {
        const auto radius =
            static_cast<std::int32_t>(anyOf(1, i % 2 == 0 ? 20 * kProbePerCell : sand::kLargestToolRadius));
        const ToolKind kind = kEvery[static_cast<std::size_t>(i) % kEvery.size()];
        const Tool tool{kind, radius, sand::isRound(kind) ? 0 : radius / 2};
        const auto z = static_cast<std::int32_t>(anyOf(-sand::kMaxProbe, sand::kMaxProbe) >> (i % 3 * 6));
        const sand::Offset first{anyOf(-radius, radius), anyOf(-radius, radius)};
        std::array<std::int32_t, 37> row{};
        for (const base::CodePath path : {base::CodePath::baseline, base::fastestCodePath()}) {
            const sand::TurnedShape shape(tool, sand::TurnedShape::SphereRing::wide, path);
            shape.undersides(z, first, row);
            for (std::int64_t x = 0; x < std::ssize(row); ++x) {
                ASSERT_EQ(row[static_cast<std::size_t>(x)], shape.underside(z, {first.x + x * kProbePerCell, first.y}))
                    << base::nameOf(kind) << " of radius " << radius << ", cell " << x;
            }
        }
    }
}

}  // namespace
