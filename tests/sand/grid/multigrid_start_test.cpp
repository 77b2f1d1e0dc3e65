// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/multigrid_start.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sand/grid/dual_projection.hpp"
#include "tests/support/sand/oracles.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using sand::HeightField;
using sand::Rules;
using sand::grid::DualProjection;

Rules rulesFor(const HeightField& field, sand::Rim rim = sand::Rim::closed) {
    Rules rules;
    rules.columns = field.columns();
    rules.rows = field.rows();
    rules.tuning.threshold = rules.tuning.startThreshold = sand::kUnitsPerCell;
    rules.rim = rim;
    return rules;
}

/// Returns hills and pits as wide as a quarter of the field. They are up to three times too steep along either axis, so
/// that all sand moves.
HeightField bumps(int columns, int rows) {
    const double width = columns / 4.0;
    const double height = 3 * width / (2 * std::numbers::pi);
    return oracles::fieldOf(columns, rows, [&](double x, double y) {
        // All heights are at least 0, because an open rim allows no sand below.
        return height * (2 + std::sin(2 * std::numbers::pi * x / width) + std::sin(2 * std::numbers::pi * y / width));
    });
}

/// Returns the root of the summed squared differences [cell] between the results of two sets of fluxes on one field.
double distanceBetween(const HeightField& field, const DualProjection& a, const DualProjection& b) {
    const auto rise = [](const DualProjection& p, int x, int y) {
        return static_cast<double>(p.eastFlux(x - 1, y) - p.eastFlux(x, y) + p.northFlux(x, y - 1) - p.northFlux(x, y));
    };
    double sum = 0;
    for (int y = 0; y < field.rows(); ++y) {
        for (int x = 0; x < field.columns(); ++x) {
            const double difference = (rise(a, x, y) - rise(b, x, y)) / sand::kUnitsPerCell;
            sum += difference * difference;
        }
    }
    return std::sqrt(sum);
}

double squaredChange(const HeightField& field, const DualProjection& projection) {
    double sum = 0;
    for (int y = 0; y < field.rows(); ++y) {
        for (int x = 0; x < field.columns(); ++x) {
            const auto rise = static_cast<double>(projection.eastFlux(x - 1, y) - projection.eastFlux(x, y) +
                                                  projection.northFlux(x, y - 1) - projection.northFlux(x, y)) /
                              sand::kUnitsPerCell;
            sum += rise * rise;
        }
    }
    return sum;
}

struct Runs {
    int direct, nested;
};

/// Projects directly and from coarser cells, and expects the same pile.
Runs expectSamePile(const HeightField& field, const Rules& rules) {
    DualProjection direct(field, rules);
    DualProjection nested(field, rules);
    sand::grid::startFromCoarser(nested, field, rules);
    const Runs runs{direct.run(), nested.run()};
    // If no quad is too steep, heights with a duality gap g are within the root of 2g of the projection. Either run
    // stops at 1e-5 of the squared change. Heights may be 3 % too steep in places, which the gap does not show.
    // Therefore the distance is doubled.
    const double farthest = 2 * 2 * std::sqrt(2 * 1e-5 * squaredChange(field, direct));
    EXPECT_GT(farthest, 0);
    EXPECT_LE(distanceBetween(field, direct, nested), farthest);
    return runs;
}

TEST(CoarseStart, EndsInTheSamePile) {
    for (const auto rim : {sand::Rim::closed, sand::Rim::open}) {
        for (const auto& [columns, rows] : {std::pair{64, 64}, {77, 50}, {33, 130}}) {
            const HeightField field = bumps(columns, rows);
            expectSamePile(field, rulesFor(field, rim));
        }
    }
    const HeightField pile = samples::cylinder(96, 24, 20);
    expectSamePile(pile, rulesFor(pile));
}

TEST(CoarseStart, EndsInTheSamePileOnLongCells) {
    const HeightField field = bumps(80, 60);
    for (const std::int32_t aspect : {sand::kUnitsPerCell / 2, 2 * sand::kUnitsPerCell}) {
        Rules rules = rulesFor(field);
        rules.aspect = aspect;
        expectSamePile(field, rules);
    }
}

// Sand that moves as a whole takes iterations in proportion to the side of the field. The coarse cells do those.
TEST(CoarseStart, SparesIterationsWhereEverythingMoves) {
    const HeightField plane = oracles::fieldOf(128, 128, [](double x, double y) { return 2.1 * (0.8 * x + 0.6 * y); });
    const Runs onPlane = expectSamePile(plane, rulesFor(plane));
    EXPECT_LE(onPlane.nested * 4, onPlane.direct);
    // The saving grows with the field: little here, two thirds at 512 cells.
    const HeightField hills = bumps(128, 128);
    const Runs onHills = expectSamePile(hills, rulesFor(hills));
    EXPECT_LT(onHills.nested, onHills.direct);
}

TEST(CoarseStart, LeavesRestAlone) {
    const HeightField level(100, 70, 1.0);
    const Rules rules = rulesFor(level);
    DualProjection projection(level, rules);
    sand::grid::startFromCoarser(projection, level, rules);
    EXPECT_TRUE(projection.atRest());
    EXPECT_EQ(projection.run(), 0);
}

}  // namespace
