// SPDX-License-Identifier: Apache-2.0
// The band: sand at rest starts to slide at t (1 + band), and sliding sand stops at t.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/support/sand/oracles.hpp"
#include "tests/support/sand/relaxing.hpp"

namespace {

using samples::Law;
using samples::nameOf;
using sand::HeightField;

constexpr int kSide = 72;                       // [cell]
constexpr double kTalus = 0.57735026918962576;  // of 30 degrees
constexpr std::int32_t kThreshold = 37837;      // [unit], the same talus as a difference between cells
constexpr std::array kBands{0.001, 0.01, 0.05, 0.2, 0.5};
constexpr std::array kDirections{0.0, 22.5, 45.0, 70.0, 90.0, 157.5, 225.0, 292.5};  // [degree]

/// Returns a bank that rises at `slope` [talus] towards `degrees` across the middle of the field. It is 12 cells high
/// and lies between two levels.
HeightField bank(double slope, double degrees) {
    const oracles::Line line{kSide / 2.0, kSide / 2.0, degrees};
    return oracles::fieldOf(kSide, kSide, [&](double x, double y) {
        return std::clamp(6 + slope * kTalus * line.across(x, y), 0.0, 12.0);
    });
}

struct Rest {
    double mean;      // slope of the sand that slid [talus]
    double steepest;  // steepest face [talus]
    std::int64_t sweeps;
    bool moved;
};

Rest restOf(const HeightField& start, const Law& law) {
    HeightField field = start;
    const std::int64_t sweeps = samples::relax(field, samples::rulesFor(field, law, kThreshold));
    double sum = 0;
    int count = 0;
    for (int y = 1; y + 1 < kSide; ++y) {
        for (int x = 1; x + 1 < kSide; ++x) {
            // A cell between the two levels that the slide has changed. Its slope is that of the plane through its
            // neighbours.
            const double height = field.height(x, y) / 65536.0;
            if (std::abs(height - 6) < 4 && field.height(x, y) != start.height(x, y)) {
                sum += std::hypot(field.height(x + 1, y) - field.height(x - 1, y),
                                  field.height(x, y + 1) - field.height(x, y - 1)) /
                       2;
                ++count;
            }
        }
    }
    return {sum / std::max(count, 1) / kThreshold, 1 + samples::steepestExcess(field, kThreshold) / kThreshold, sweeps,
            count > 0};
}

TEST(Band, SandThatSlidStopsAtTheTalusInEveryDirection) {
    for (const sand::Scheme scheme : samples::kSchemes) {
        for (const double slope : {1.5, 3.0, 8.0}) {
            for (const double degrees : kDirections) {
                const HeightField start = bank(slope, degrees);
                const Rest without = restOf(start, scheme);
                ASSERT_TRUE(without.moved);
                for (const double band : kBands) {
                    if (slope < 1 + band + 0.01) {
                        continue;  // the slide never starts
                    }
                    const Rest rest = restOf(start, {scheme, band});
                    SCOPED_TRACE(testing::Message()
                                 << nameOf({scheme, band}) << ", bank of " << slope << " t towards " << degrees
                                 << " degrees, " << rest.sweeps << " sweeps and without " << without.sweeps);
                    EXPECT_NEAR(rest.mean, without.mean, 0.01 * without.mean);
                    EXPECT_LE(rest.steepest, without.steepest + 0.01);
                }
            }
        }
    }
}

/// Nothing moves while no face is steeper than the start threshold.
TEST(Band, SandAtRestStaysUpToTheStartThreshold) {
    for (const sand::Scheme scheme : samples::kSchemes) {
        for (const double band : kBands) {
            for (const double degrees : kDirections) {
                HeightField field = bank((1 + band) * 0.9995, degrees);
                const HeightField start = field;
                EXPECT_EQ(samples::relax(field, samples::rulesFor(field, {scheme, band}, kThreshold)), 1);
                EXPECT_TRUE(sameHeights(field, start)) << nameOf({scheme, band}) << ", " << degrees;
            }
        }
    }
}

TEST(Band, SandAtRestSlidesBeyondTheStartThreshold) {
    for (const sand::Scheme scheme : samples::kSchemes) {
        for (const double band : kBands) {
            for (const double degrees : kDirections) {
                // A bank is sampled in steps of a sixteenth of a cell. One step is a share of 0.002 of its height.
                EXPECT_TRUE(restOf(bank((1 + band) * 1.01, degrees), {scheme, band}).moved)
                    << nameOf({scheme, band}) << ", " << degrees;
            }
        }
    }
}

// A slide beside sand at rest changes nothing, because only the sand's own slope decides whether it moves.
TEST(Band, ASlideLeavesTheSandThatItDoesNotReach) {
    for (const sand::Scheme scheme : samples::kSchemes) {
        for (const double band : {0.05, 0.5}) {
            HeightField field = oracles::fieldOf(160, 40, [&](double x, double) {
                const double slides = std::clamp(5 + 3 * kTalus * (x - 40), 0.0, 10.0);
                return slides + std::clamp((1 + band / 2) * kTalus * (x - 110), 0.0, 10.0);
            });
            const HeightField start = field;
            samples::relax(field, samples::rulesFor(field, {scheme, band}, kThreshold));
            EXPECT_NE(field.height(40, 20), start.height(40, 20));
            for (int y = 0; y < 40; ++y) {
                EXPECT_TRUE(std::equal(field.row(y) + 80, field.row(y) + 160, start.row(y) + 80))
                    << nameOf({scheme, band});
            }
        }
    }
}

}  // namespace
