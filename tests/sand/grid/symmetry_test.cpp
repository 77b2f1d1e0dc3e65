// SPDX-License-Identifier: Apache-2.0
// Sliding prefers no direction, and sand at rest stays at rest.
#include <gtest/gtest.h>

#include <random>

#include "tests/support/sand/relaxing.hpp"
#include "tests/support/sand/sand_samples.hpp"
#include "tests/support/sand/turned.hpp"

namespace {

using samples::Law;
using samples::nameOf;
using sand::HeightField;
using sand::Rim;
using sand::grid::Erosion;

TEST(Symmetry, SlidingCommutesWithFlipsAndTransposition) {
    std::mt19937 random(11);
    for (const Law& law : samples::laws()) {
        for (const Rim rim : {Rim::closed, Rim::open}) {
            const HeightField start = samples::randomField(50, 71, 1 << 22, random);
            sand::Rules rules = samples::rulesFor(start, law);
            rules.rim = rim;
            HeightField field = start;
            const std::int64_t outflow = Erosion(field, rules).sweep(field, 60);
            for (unsigned way = 1; way < 8; ++way) {
                HeightField image = samples::turned(start, way);
                rules = samples::rulesFor(image, law);
                rules.rim = rim;
                EXPECT_EQ(Erosion(image, rules).sweep(image, 60), outflow);
                EXPECT_TRUE(sameHeights(samples::turned(field, way), image)) << nameOf(law) << ", way " << way;
            }
        }
    }
}

TEST(Symmetry, NoTwoWaysAreTheSame) {
    std::mt19937 random(12);
    const HeightField field = samples::randomField(6, 6, 1 << 22, random);
    for (unsigned a = 0; a < 8; ++a) {
        for (unsigned b = 0; b < a; ++b) {
            EXPECT_FALSE(sameHeights(samples::turned(field, a), samples::turned(field, b)));
        }
    }
}

TEST(Symmetry, ARestStateIsAFixedPoint) {
    std::mt19937 random(13);
    for (const Law& law : samples::laws()) {
        for (const Rim rim : {Rim::closed, Rim::open}) {
            HeightField field = samples::randomField(67, 45, 1 << 21, random);
            sand::Rules rules = samples::rulesFor(field, law);
            rules.rim = rim;
            samples::relax(field, rules);
            const HeightField rest = field;
            Erosion again(field, rules);
            EXPECT_EQ(again.sweep(field, 10), 0);
            EXPECT_EQ(again.sweepsDone(), 1) << "the one sweep that finds nothing to do; " << nameOf(law);
            EXPECT_TRUE(sameHeights(field, rest)) << nameOf(law);
        }
    }
}

}  // namespace
