// SPDX-License-Identifier: Apache-2.0
// Long walls of sand and tilted planes, along the grid's axes and in other directions (oracles.hpp, O2 and O5).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "tests/support/sand/oracles.hpp"
#include "tests/support/sand/relaxing.hpp"

namespace {

using oracles::Line;
using oracles::Prism;
using samples::Law;
using samples::nameOf;
using sand::HeightField;

/// Returns the misplaced share of an endless prism along a grid axis.
double misplacedOnAxis(int n, const Prism& prism, bool alongRows, const Law& law) {
    constexpr int kLength = 8;  // [cell]; all cross-sections are the same
    const int columns = alongRows ? kLength : n;
    const int rows = alongRows ? n : kLength;
    const Line line{columns / 2.0, rows / 2.0, alongRows ? 90.0 : 0.0};
    HeightField field =
        oracles::fieldOf(columns, rows, [&](double x, double y) { return prism.start(line.across(x, y)); });
    samples::relax(field, samples::rulesFor(field, law));
    const auto expected =
        oracles::sampled(columns, rows, [&](double x, double y) { return prism.rest(line.across(x, y)); });
    return oracles::distance(field, expected).misplaced;
}

/// Returns the misplaced share in the middle of a turned prism, which ends within the field.
double misplacedAslant(int n, const Prism& prism, double degrees, const Law& law) {
    const Line line{n / 2.0, n / 2.0, degrees};
    HeightField field = oracles::fieldOf(n, n, [&](double x, double y) {
        return std::abs(line.along(x, y)) < 0.4 * n ? prism.start(line.across(x, y)) : 0;
    });
    samples::relax(field, samples::rulesFor(field, law));
    const auto expected = oracles::sampled(n, n, [&](double x, double y) { return prism.rest(line.across(x, y)); });
    const auto inTheMiddle = [&](int x, int y) { return std::abs(line.along(x + 0.5, y + 0.5)) < 0.15 * n; };
    return oracles::distance(field, expected, inTheMiddle).misplaced;
}

/// Returns a number near `halfWidth` for a prism at 45 degrees. Its sides then lie between the 16 x 16 samples of its
/// cells, so that its volume is exact. On a line of samples, half of them would be missing.
double betweenDiagonals(double halfWidth) {
    return (std::round(halfWidth * std::numbers::sqrt2) + 1.0 / 32) / std::numbers::sqrt2;
}

struct Resolution {
    int n;
    double allowed;
};

// Largest misplaced share of the sand; it is smaller with smaller cells.
constexpr std::array kResolutions{Resolution{64, 0.003}, Resolution{128, 0.0025}, Resolution{256, 0.0008}};

TEST(PrismOracle, LowWallBecomesItsRampOnEitherAxis) {
    for (const Law& law : samples::laws()) {
        for (const auto& [n, allowed] : kResolutions) {
            for (const bool alongRows : {false, true}) {
                EXPECT_LE(misplacedOnAxis(n, {0.25 * n, 0.15 * n}, alongRows, law), allowed)
                    << nameOf(law) << ", " << n << " cells";
            }
        }
    }
}

TEST(PrismOracle, LowWallBecomesItsRampOffTheAxes) {
    for (const Law& law : samples::laws()) {
        for (const auto& [n, allowed] : kResolutions) {
            if (n == 256 && samples::kSanitized) {
                continue;
            }
            EXPECT_LE(misplacedAslant(n, {0.15 * n, 0.09 * n}, 22.5, law), allowed) << nameOf(law) << ", " << n;
            const double halfWidth = betweenDiagonals(0.17 * n);
            EXPECT_LE(misplacedAslant(n, {halfWidth, 0.6 * halfWidth}, 45, law), allowed) << nameOf(law) << ", " << n;
        }
    }
}

// Two feet and a ridge that is twice as sharp are rounded like four kinks of 0.25 cells² each (pile_oracle_test.cpp).
// Turning either slope about its mean height by its resting excess misplaces half of that excess.
double allowedForRoof(const Prism& prism) {
    return 4 * 0.25 / prism.area() + 0.5 * samples::restingExcess(sand::kUnitsPerCell) / sand::kUnitsPerCell;
}

TEST(PrismOracle, TallWallBecomesARoofInAnyDirection) {
    for (const Law& law : samples::laws()) {
        for (const int n : {64, 128, 256}) {
            if (n > (law.inertial() ? 256 : 128)) {
                continue;  // takes seconds without inertia
            }
            const Prism prism(n / 16.0, n / 4.0);
            const double halfWidth = betweenDiagonals(n / 16.0);
            const Prism diagonal(halfWidth, 4 * halfWidth);
            EXPECT_LE(misplacedOnAxis(n, prism, false, law), allowedForRoof(prism)) << nameOf(law) << ", " << n;
            EXPECT_LE(misplacedAslant(n, prism, 22.5, law), allowedForRoof(prism)) << nameOf(law) << ", " << n;
            EXPECT_LE(misplacedAslant(n, diagonal, 45, law), allowedForRoof(diagonal)) << nameOf(law) << ", " << n;
        }
    }
}

TEST(PlaneOracle, UpToTheTalusNothingMovesInAnyDirection) {
    for (const Law& law : samples::laws()) {
        for (int degrees = 0; degrees < 360; degrees += 15) {
            // Both heights are rounded down, so that a difference may exceed the slope by a unit on either axis.
            const double slope = sand::kUnitsPerCell - 2;
            const double east = slope * std::cos(degrees * std::numbers::pi / 180);
            const double north = slope * std::sin(degrees * std::numbers::pi / 180);
            HeightField field(40, 30, 1.0);
            for (int y = 0; y < 30; ++y) {
                for (int x = 0; x < 40; ++x) {
                    field.setHeight(x, y, static_cast<std::int32_t>(std::floor(east * x + north * y)));
                }
            }
            const HeightField before = field;
            EXPECT_EQ(samples::relax(field, samples::rulesFor(field, law)), 1)
                << "the one sweep that finds nothing to do; " << nameOf(law) << " at " << degrees << " degrees";
            EXPECT_TRUE(sameHeights(field, before));
        }
    }
}

// The profile is straight, so that only errors of units remain and no grid error. A difference is at rest if its flux
// is less than a unit: up to 1 / 0.2499 units above the threshold without inertia, 1 / 0.45 with inertia. Over half a
// field this adds up to at most n / 2 times as much at the ends.
TEST(PlaneOracle, AboveTheTalusAPlaneTurnsAboutItsCentroid) {
    for (const Law& law : samples::laws()) {
        const double excess = law.inertial() ? 1 / 0.45 : 1 / 0.2499;  // [unit]
        for (const double slope : {1.2, 2.0, 5.0}) {
            for (const int n : {64, 128, 256}) {
                if (n > (law.inertial() ? 256 : 128)) {
                    continue;  // takes seconds without inertia
                }
                const oracles::TiltedPlane plane(n, slope);
                HeightField field = oracles::fieldOf(n, 8, [&](double x, double) { return plane.start(x); });
                samples::relax(field, samples::rulesFor(field, law));
                const auto expected = oracles::sampled(n, 8, [&](double x, double) { return plane.rest(x); });
                const oracles::Distance distance = oracles::distance(field, expected);
                EXPECT_LE(distance.largest * sand::kUnitsPerCell, (excess + 1) * n / 2)
                    << nameOf(law) << ", slope " << slope << ", " << n << " cells";
                EXPECT_LE(distance.misplaced, 0.0001);
            }
        }
    }
}

}  // namespace
