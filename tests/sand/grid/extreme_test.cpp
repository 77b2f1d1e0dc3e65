// SPDX-License-Identifier: Apache-2.0
// Heights and sizes at the ends of their ranges. extreme_worlds_test.cpp has more of them, and angles and cells.
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <stdexcept>

#include "tests/support/sand/relaxing.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using samples::Law;
using samples::nameOf;
using sand::HeightField;
using sand::kMaxHeight;

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
