// SPDX-License-Identifier: Apache-2.0
// Angles, heights, cells and sizes at the ends of their ranges.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include "tests/support/relaxing.hpp"
#include "tests/support/sand_samples.hpp"

namespace {

using samples::Law;
using samples::nameOf;
using sand::HeightField;
using sand::kMaxHeight;

std::int32_t thresholdOf(double degrees) {
    return static_cast<std::int32_t>(std::tan(degrees * std::numbers::pi / 180) * sand::kUnitsPerCell);
}

/// Returns level ground at `base` with one cell at `height`.
HeightField spike(std::int32_t base, std::int32_t height) {
    HeightField field(33, 31, 1.0);
    for (int y = 0; y < 31; ++y) {
        std::fill_n(field.row(y), 33, base);
    }
    field.setHeight(16, 15, height);
    return field;
}

bool moves(HeightField field, const Law& law, std::int32_t threshold) {
    const HeightField before = field;
    samples::relax(field, samples::rulesFor(field, law, threshold));
    return !sameHeights(field, before);
}

// A face is at rest if a quarter of its difference is less than a unit.
TEST(ExtremeAngle, ZeroRestsWithinFourUnitsPerCell) {
    for (const Law& law : samples::laws()) {
        std::mt19937 random(19);
        HeightField field = samples::randomField(31, 33, 1 << 16, random);
        samples::relax(field, samples::rulesFor(field, law, 0));
        for (int y = 1; y < 33; ++y) {
            for (int x = 1; x < 31; ++x) {
                EXPECT_LE(std::abs(field.height(x, y) - field.height(x - 1, y)), 4) << nameOf(law);
                EXPECT_LE(std::abs(field.height(x, y) - field.height(x, y - 1)), 4) << nameOf(law);
            }
        }
    }
}

TEST(ExtremeAngle, SpikesMoveBeyondTheThresholdAndNoOthers) {
    for (const Law& law : samples::laws()) {
        const std::int32_t steep = thresholdOf(89.9);  // 573 cells between neighbouring cells
        EXPECT_FALSE(moves(spike(0, steep), law, steep)) << nameOf(law);
        const auto held = static_cast<std::int32_t>(law.band * steep);
        EXPECT_FALSE(moves(spike(0, steep + held), law, steep)) << nameOf(law);
        EXPECT_TRUE(moves(spike(0, steep + held + 1000), law, steep)) << nameOf(law);
        const std::int32_t steeper = thresholdOf(89.99);  // 5730 cells, more than the range above zero
        EXPECT_FALSE(moves(spike(0, kMaxHeight), law, steeper)) << nameOf(law);
        EXPECT_TRUE(moves(spike(-kMaxHeight, kMaxHeight), law, steeper)) << nameOf(law);
        // 89.995 degrees and every steeper angle exceed the whole range.
        for (const std::int32_t steepest : {thresholdOf(89.995), 1 << 30}) {
            EXPECT_FALSE(moves(spike(-kMaxHeight, kMaxHeight), law, steepest)) << nameOf(law);
            EXPECT_FALSE(moves(spike(kMaxHeight, -kMaxHeight), law, steepest)) << nameOf(law);
        }
    }
}

TEST(ExtremeHeight, SpikesAndPitsOfTheWholeRangeComeToRest) {
    for (const Law& law : samples::laws()) {
        for (const auto& [base, height] :
             {std::pair{0, kMaxHeight}, {0, -kMaxHeight}, {-kMaxHeight, kMaxHeight}, {kMaxHeight, -kMaxHeight}}) {
            HeightField field = spike(base, height);
            samples::relax(field, samples::rulesFor(field, law));
            EXPECT_LE(samples::steepestExcess(field, sand::kUnitsPerCell), samples::restingExcess(sand::kUnitsPerCell))
                << nameOf(law) << ", " << height << " over " << base;
        }
    }
}

TEST(ExtremeHeight, ACheckerboardOfTheWholeRangeComesToRest) {
    for (const Law& law : samples::laws()) {
        HeightField field(33, 31, 1.0);
        for (int y = 0; y < 31; ++y) {
            for (int x = 0; x < 33; ++x) {
                field.setHeight(x, y, (x + y) % 2 == 0 ? kMaxHeight : -kMaxHeight);
            }
        }
        samples::relax(field, samples::rulesFor(field, law));
        const samples::Extremes rest = samples::extremesOf(field);
        EXPECT_LE(rest.highest - std::int64_t{rest.lowest}, 33 * sand::kUnitsPerCell * std::numbers::sqrt2)
            << nameOf(law) << ": no higher than a slope from corner to corner";
    }
}

TEST(ExtremeHeight, RandomHeightsOfTheWholeRangeFallOverAnOpenRim) {
    for (const Law& law : samples::laws()) {
        std::mt19937 random(23);
        HeightField field = samples::randomField(33, 31, kMaxHeight, random);
        sand::Rules rules = samples::rulesFor(field, law);
        rules.rim = sand::Rim::open;
        samples::relax(field, rules);
        EXPECT_LE(samples::extremesOf(field).highest, 17 * sand::kUnitsPerCell)
            << nameOf(law) << ": no higher than a slope from the rim to the middle";
    }
}

TEST(ExtremeHeight, AShallowPitStays) {
    for (const Law& law : samples::laws()) {
        EXPECT_FALSE(moves(spike(0, -sand::kUnitsPerCell), law, sand::kUnitsPerCell)) << nameOf(law);
        EXPECT_TRUE(moves(spike(0, -2 * sand::kUnitsPerCell), law, sand::kUnitsPerCell)) << nameOf(law);
    }
}

TEST(ExtremeHeight, DifferencesOfAUnitRestAtAnyAngle) {
    for (const Law& law : samples::laws()) {
        EXPECT_FALSE(moves(spike(0, 1), law, 0)) << nameOf(law);
        EXPECT_FALSE(moves(spike(0, 1), law, 1)) << nameOf(law);
    }
}

// Across cells r = 1000 times as long as wide, a flux moves so much sand that it must be a tiny share of the
// difference. The share is at most 0.45 / r² with inertia, and 0.4998 / (r² + 1) without. A face rests if its excess
// over the threshold is less than a unit divided by that share: a dead band of 2.2 million units. That is 3 % of a
// threshold of r cells. If cells are long from west to east, heights are in units of that length, and it is 34 times
// the threshold.
TEST(ExtremeCell, OneToAThousandRestsWithinItsDeadBand) {
    constexpr double kRatio = 1000;
    for (const Law& law : samples::laws()) {
        const double share = law.inertial() ? 0.45 / (kRatio * kRatio) : 0.4998 / (kRatio * kRatio + 1);
        if (samples::kSanitized && !law.inertial()) {
            continue;  // takes ten times the sweeps without inertia
        }
        for (const bool longNorthward : {true, false}) {
            // The start is near its rest, because the distance shrinks by a factor of e only in two million sweeps.
            const std::int32_t height = longNorthward ? 72000000 : 5000000;
            HeightField field(longNorthward ? 1 : 5, longNorthward ? 5 : 1, 1.0);
            const auto heightAt = [&](int i) { return longNorthward ? field.height(0, i) : field.height(i, 0); };
            longNorthward ? field.setHeight(0, 2, height) : field.setHeight(2, 0, height);
            sand::Rules rules = samples::rulesFor(field, law);
            // Cells 1000 times as wide as long become 993 times as wide, because a rule is a whole number of 2^-16.
            rules.aspect = longNorthward ? 1000 * sand::kUnitsPerCell : 66;
            samples::relax(field, rules, 100000000);
            const double threshold = (longNorthward ? kRatio : 1) * sand::kUnitsPerCell;
            for (int i = 1; i < 5; ++i) {
                EXPECT_LE(std::abs(heightAt(i) - heightAt(i - 1)), threshold + 1.001 / share)
                    << nameOf(law) << ", cell " << i;
            }
            EXPECT_LT(heightAt(2), height - 1000000) << "it does flow";
        }
    }
}

TEST(ExtremeCell, OneToAThousandMovesNothingWithinItsDeadBand) {
    for (const Law& law : samples::laws()) {
        HeightField field(9, 3, 1.0);
        for (int y = 0; y < 3; ++y) {
            field.setHeight(4, y, 2000000);  // 30 times the threshold
        }
        const HeightField before = field;
        sand::Rules rules = samples::rulesFor(field, law);
        rules.aspect = 66;
        samples::relax(field, rules);
        EXPECT_TRUE(sameHeights(field, before)) << nameOf(law);
    }
}

TEST(ExtremeSize, FieldsOfAnyShapeKeepTheirVolume) {
    for (const Law& law : samples::laws()) {
        for (const auto rim : {sand::Rim::closed, sand::Rim::open}) {
            for (const auto& [columns, rows] : {std::pair{1, 1},
                                                {1, 40},
                                                {40, 1},
                                                {1, 2},
                                                {2, 2},
                                                {31, 31},
                                                {31, 33},
                                                {32, 32},
                                                {33, 32},
                                                {33, 33}}) {
                HeightField field(columns, rows, 1.0);
                field.setHeight(columns / 2, rows / 2, kMaxHeight / 8);
                field.setHeight(0, 0, kMaxHeight / 16);
                sand::Rules rules = samples::rulesFor(field, law);
                rules.rim = rim;
                for (const int block : {16, 32}) {
                    HeightField copy = field;
                    const std::int64_t volume = copy.volume();
                    sand::grid::Erosion erosion(copy, rules, {.blockSize = block});
                    const std::int64_t outflow = erosion.sweep(copy, 1000000);
                    EXPECT_TRUE(erosion.settled()) << nameOf(law) << ", " << columns << " x " << rows;
                    EXPECT_EQ(copy.volume() + outflow, volume) << nameOf(law) << ", " << columns << " x " << rows;
                    EXPECT_EQ(outflow > 0, rim == sand::Rim::open);
                }
            }
        }
    }
}

TEST(ExtremeSize, TheLongestRowsWork) {
    for (const auto& [columns, rows] : {std::pair{sand::kMaxSide, 3}, {3, sand::kMaxSide}}) {
        HeightField field(columns, rows, 1.0);
        field.setHeight(columns - 1, rows - 1, 64 * sand::kUnitsPerCell);
        field.setHeight(columns / 2, rows / 2, 64 * sand::kUnitsPerCell);
        samples::relax(field, samples::rulesFor(field));
        EXPECT_LT(field.height(columns - 1, rows - 1), 20 * sand::kUnitsPerCell);
    }
}

TEST(ExtremeSize, BeyondTheLargestSideIsRefused) {
    EXPECT_THROW(HeightField(sand::kMaxSide + 1, 1, 1.0), std::invalid_argument);
    EXPECT_THROW(HeightField(1, sand::kMaxSide + 1, 1.0), std::invalid_argument);
    EXPECT_THROW(HeightField(0, 1, 1.0), std::invalid_argument);
    EXPECT_THROW(HeightField(1, -1, 1.0), std::invalid_argument);
    for (const double cell :
         {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        EXPECT_THROW(HeightField(1, 1, cell), std::invalid_argument) << cell;
    }
}

}  // namespace
