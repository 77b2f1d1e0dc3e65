// SPDX-License-Identifier: Apache-2.0
// Sweeps leave out blocks that are certainly at rest. That must not change the sand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sand/grid/erosion.hpp"
#include "tests/support/machine/heap_count.hpp"
#include "tests/support/sand/relaxing.hpp"

namespace {

using sand::HeightField;
using sand::grid::Erosion;

/// Returns sand whose slopes are on both sides of the threshold, from place to place.
HeightField slopesAround(const sand::Rules& rules, std::mt19937& random) {
    HeightField field(rules.columns, rules.rows, 1.0);
    const double ratio = static_cast<double>(rules.aspect) / sand::kUnitsPerCell;
    const auto share = [&] { return static_cast<double>(random() % 1000U) / 1000; };
    const double steepest = 0.3 + share();  // of the threshold
    for (int y0 = 0; y0 < rules.rows; y0 += 16) {
        for (int x0 = 0; x0 < rules.columns; x0 += 16) {
            const double slope = steepest * share() * rules.tuning.threshold, turn = 6.283 * share();
            const double base = 8 * rules.tuning.threshold;
            for (int y = y0; y < std::min(y0 + 16, rules.rows); ++y) {
                for (int x = x0; x < std::min(x0 + 16, rules.columns); ++x) {
                    const double away = (x - x0 - 8) * std::cos(turn) + (y - y0 - 8) * ratio * std::sin(turn);
                    field.setHeight(x, y, static_cast<std::int32_t>(base + slope * away));
                }
            }
        }
    }
    return field;
}

/// Returns random rules: schemes, rims, bands, and the proportions of cells.
sand::Rules anyRules(std::mt19937& random) {
    HeightField size(17 + static_cast<int>(random() % 100U), 1 + static_cast<int>(random() % 90U), 1.0);
    sand::Rules rules = samples::rulesFor(size);
    rules.scheme = random() % 2 == 0 ? sand::Scheme::isotropic : sand::Scheme::plainIsotropic;
    rules.rim = random() % 2 == 0 ? sand::Rim::closed : sand::Rim::open;
    rules.aspect =
        random() % 2 == 0 ? sand::kUnitsPerCell : sand::kUnitsPerCell / 3 * static_cast<int>(1 + random() % 9U);
    rules.tuning.startThreshold = rules.tuning.threshold + static_cast<int>(random() % 3U) * 1000;
    return rules;
}

class RestingBlocks : public testing::Test {
protected:
    /// Sweeps both, and expects equal heights and outflow. `other` visits all blocks in each sweep.
    void expectEqual(Erosion& erosion, HeightField& field, Erosion& other, HeightField& whole, int sweeps) {
        for (int n = 0; n < sweeps; ++n) {
            const auto here = erosion.sweep(field, sand::SweepPart::all(1));
            const auto there = other.sweep(whole, sand::SweepPart::all(1));
            ASSERT_EQ(here.outflow, there.outflow) << n;
            ASSERT_TRUE(sameHeights(field, whole)) << n;
            ASSERT_FALSE(erosion.amiss(field.bounds())) << n;
        }
    }
    static Erosion::Options visitsAll() {
        Erosion::Options options;
        options.skipSettled = false;
        return options;
    }
};

TEST_F(RestingBlocks, AreLeftOutWithoutAChangeOfTheSand) {
    std::mt19937 random(5);
    for (int i = 0; i < 150; ++i) {
        const sand::Rules rules = anyRules(random);
        HeightField field = slopesAround(rules, random), whole = field;
        Erosion::Options options;
        options.blockSize = 2 + static_cast<int>(random() % 15U);
        Erosion erosion(field, rules, options), other(whole, rules, visitsAll());
        ASSERT_NO_FATAL_FAILURE(expectEqual(erosion, field, other, whole, 12)) << i;
        const int x = static_cast<int>(random() % 17U),
                  y = static_cast<int>(random() % static_cast<unsigned>(rules.rows));
        for (HeightField* heights : {&field, &whole}) {
            heights->setHeight(x, y, heights->height(x, y) + 30 * sand::kUnitsPerCell);
        }
        erosion.touch({x, y, x + 1, y + 1});
        other.touch({x, y, x + 1, y + 1});
        ASSERT_NO_FATAL_FAILURE(expectEqual(erosion, field, other, whole, 12)) << i << ", after an edit";
    }
}

// Sand that slides goes on below the threshold. Its fluxes decide, not only its heights.
TEST_F(RestingBlocks, AreNotThoseWhoseSandStillSlides) {
    std::mt19937 random(6);
    int slidOn = 0;
    for (int i = 0; i < 50; ++i) {
        const sand::Rules rules = anyRules(random);
        HeightField field = slopesAround(rules, random);
        Erosion erosion(field, rules);
        erosion.sweep(field, 6);
        const sand::grid::Inertia inertia = erosion.inertia();
        sand::Rules gentle = rules;  // from now on all of this sand is below 0.7 of the threshold
        gentle.tuning.threshold = gentle.tuning.startThreshold = 3 * rules.tuning.threshold;
        HeightField whole = field;
        const HeightField before = field;
        Erosion resumed(field, gentle), other(whole, gentle, visitsAll());
        resumed.resume(inertia);
        other.resume(inertia);
        ASSERT_NO_FATAL_FAILURE(expectEqual(resumed, field, other, whole, 12)) << i;
        slidOn += sameHeights(field, before) ? 0 : 1;
    }
    EXPECT_GT(slidOn, 10);
}

// A flux to the north is kept with the cell that gives the sand. The block in the north must get it.
TEST_F(RestingBlocks, GetTheSandOfAResumedFluxFromTheBlockInTheSouth) {
    constexpr int kSide = 128, kGives = 63;
    const sand::Rules rules = samples::rulesFor(HeightField(kSide, kSide, 1.0));
    HeightField field(kSide, kSide, 1.0);
    for (int y = 0; y < kSide;
         ++y) {  // the slopes along both axes are below 0.7 of the threshold, and together near it
        for (int x = 0; x < kSide; ++x) {
            field.setHeight(x, y, (2 * kSide - x - y) * (rules.tuning.threshold / 3 * 2));
        }
    }
    sand::CellArray east(kSide, kSide), north(kSide, kSide);
    std::fill_n(north.row(kGives) + 40, 20, rules.tuning.threshold / 20);
    sand::grid::Inertia inertia(sand::grid::Inertia::kMostCounted);
    inertia.keep(east, north, {0, 0, 64, kGives + 1});
    HeightField whole = field;
    const HeightField before = field;
    Erosion resumed(field, rules), other(whole, rules, visitsAll());
    resumed.resume(inertia);
    other.resume(inertia);
    ASSERT_NO_FATAL_FAILURE(expectEqual(resumed, field, other, whole, 12));
    EXPECT_FALSE(sameHeights(field, before)) << "the sand slides on";
}

TEST_F(RestingBlocks, AreNotVisited) {
    const sand::Rules rules = samples::rulesFor(HeightField(512, 512, 1.0));
    HeightField field(512, 512, 1.0);
    field.setHeight(300, 200, 30 * sand::kUnitsPerCell);
    std::int64_t visited = 0;
    Erosion erosion(field, rules);
    erosion.sweep(field, sand::SweepPart::all(1), nullptr, [&](const sand::CellRect& cells) {
        visited += std::int64_t{cells.x1 - cells.x0} * (cells.y1 - cells.y0);
    });
    EXPECT_GT(visited, 0);
    EXPECT_LE(visited, 4 * 64) << "at most four blocks have the needle or a neighbour of it";
}

TEST_F(RestingBlocks, MayBeAllBlocks) {
    const sand::Rules rules = samples::rulesFor(HeightField(100, 70, 1.0));
    HeightField field(100, 70, 1.0);
    Erosion erosion(field, rules);
    EXPECT_FALSE(erosion.settled());
    EXPECT_TRUE(erosion.sweep(field, sand::SweepPart::all(3)).still);
    EXPECT_TRUE(erosion.settled());
    EXPECT_EQ(erosion.sweepsDone(), 1) << "as without the search";
}

TEST_F(RestingBlocks, AreFoundWithoutNewMemoryAfterTheFirstSweep) {
    const sand::Rules rules = samples::rulesFor(HeightField(300, 200, 1.0));
    HeightField field(300, 200, 1.0);
    Erosion erosion(field, rules);
    erosion.sweep(field, 1);
    for (int n = 0; n < 3; ++n) {
        erosion.wakeAll();
        const long asked = test::heapRequests();
        EXPECT_TRUE(erosion.sweep(field, sand::SweepPart::all(1)).still);
        EXPECT_EQ(test::heapRequests(), asked) << n;
    }
    EXPECT_GT(test::heapRequests(), 0) << "nobody counted";
}

}  // namespace
