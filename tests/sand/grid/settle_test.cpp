// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/settle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include "tests/support/sand/oracles.hpp"
#include "tests/support/sand/sand_samples.hpp"
#include "tests/support/seed.hpp"

namespace {

using sand::HeightField;
using sand::Rules;

Rules settlingRules(const HeightField& field, std::int32_t threshold = sand::kUnitsPerCell) {
    Rules rules;
    rules.columns = field.columns();
    rules.rows = field.rows();
    rules.tuning.threshold = rules.tuning.startThreshold = threshold;
    return rules;
}

std::pair<std::int32_t, std::int32_t> extremes(const HeightField& field) {
    std::pair<std::int32_t, std::int32_t> result{field.height(0, 0), field.height(0, 0)};
    for (int y = 0; y < field.rows(); ++y) {
        for (int x = 0; x < field.columns(); ++x) {
            result = {std::min(result.first, field.height(x, y)), std::max(result.second, field.height(x, y))};
        }
    }
    return result;
}

void expectAtRest(const HeightField& field, const Rules& rules) {
    HeightField swept = field;
    sand::grid::Erosion(swept, rules).sweep(swept, 1);
    EXPECT_TRUE(sameHeights(swept, field));
}

/// Settles a field, checks the properties that every settled field has, and returns the result of settle().
sand::grid::Settled settleAndCheck(HeightField& field, const Rules& rules) {
    const HeightField start = field;
    const auto [least, greatest] = extremes(start);
    sand::grid::NetFlux flux(field.columns(), field.rows());
    const sand::grid::Settled settled = sand::grid::settle(field, rules, &flux);
    EXPECT_EQ(field.volume() + settled.outflow, start.volume());
    const auto [low, high] = extremes(field);
    EXPECT_GE(low, rules.rim == sand::Rim::open ? std::min(least, 0) : least);
    EXPECT_LE(high, greatest);
    expectAtRest(field, rules);
    return settled;
}

/// Returns a small field with steps of any height: noise, single towers or single pits.
HeightField roughField(std::mt19937& random) {
    HeightField field(static_cast<int>(1 + random() % 12), static_cast<int>(1 + random() % 12), 0.1);
    const auto shape = random() % 3;
    const std::uint32_t high = 1U << random() % 28;
    for (int y = 0; y < field.rows(); ++y) {
        for (int x = 0; x < field.columns(); ++x) {
            const bool tower = (random() % 8 == 0) != (shape == 2);
            field.setHeight(x, y, static_cast<std::int32_t>(shape == 0 ? random() % high : tower ? high : 0));
        }
    }
    return field;
}

// In such fields the projection often ends beyond the old extremes. The surplus then goes to all neighbours.
TEST(Settle, LosesNothingOfSmallRoughFields) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    for (int i = 0; i < 2000 && !HasFailure(); ++i) {
        HeightField field = roughField(random);
        Rules rules = settlingRules(field, static_cast<std::int32_t>(1 + random() % (2U << random() % 20)));
        rules.rim = random() % 2 == 0 ? sand::Rim::closed : sand::Rim::open;
        SCOPED_TRACE(i);
        settleAndCheck(field, rules);
    }
}

double errorOfCylinder(int n, double heightPerRadius) {
    const oracles::Cylinder pile(0.25 * n, heightPerRadius * 0.25 * n);
    const double middle = n / 2.0;
    HeightField field =
        oracles::fieldOf(n, n, oracles::around(middle, middle, [&](double r) { return pile.start(r); }));
    EXPECT_GT(settleAndCheck(field, settlingRules(field)).iterations, 0) << "the projection was of no use";
    const auto expected =
        oracles::sampled(n, n, oracles::around(middle, middle, [&](double r) { return pile.rest(r); }));
    return oracles::distance(field, expected).misplaced;
}

// O1: the bounds are those of plain sweeps (pile_oracle_test.cpp), which take a hundred times as long.
TEST(Settle, CylinderBecomesItsFrustum) {
    EXPECT_LE(errorOfCylinder(64, 0.6), 0.003);
    EXPECT_LE(errorOfCylinder(128, 0.6), 0.001);
    EXPECT_LE(errorOfCylinder(256, 0.6), 0.0004);
}

// A cone's apex is one cell that has a kink in every direction, so that its error may be larger than a frustum's.
TEST(Settle, TallCylinderBecomesItsCone) {
    EXPECT_LE(errorOfCylinder(64, 3), 0.005);
    EXPECT_LE(errorOfCylinder(128, 3), 0.0025);
}

double errorOfPrism(int n, double heightPerWidth) {
    const oracles::Prism pile(n / 8.0, heightPerWidth * n / 8.0);
    HeightField field = oracles::fieldOf(n, 8, [&](double x, double) { return pile.start(x - n / 2.0); });
    settleAndCheck(field, settlingRules(field));
    const auto expected = oracles::sampled(n, 8, [&](double x, double) { return pile.rest(x - n / 2.0); });
    return oracles::distance(field, expected).misplaced;
}

// O2: low and tall prism have an error of 0.25 % at 128 cells and 0.08 % at 256 cells.
TEST(Settle, PrismBecomesItsRamp) {
    for (const double height : {1.0, 4.0}) {
        EXPECT_LE(errorOfPrism(128, height), 0.0025) << height;
        EXPECT_LE(errorOfPrism(256, height), 0.0008) << height;
    }
}

TEST(Settle, RestIsAFixedPoint) {
    HeightField field = samples::cylinder(64, 16, 12);
    const Rules rules = settlingRules(field);
    sand::grid::settle(field, rules);
    const HeightField rest = field;
    const sand::grid::Settled again = sand::grid::settle(field, rules);
    EXPECT_TRUE(sameHeights(field, rest));
    EXPECT_EQ(again.iterations + again.sweeps, 0);
}

// Sand that the start threshold holds is at rest. All other sand settles to the threshold.
TEST(Settle, BandHoldsOrLetsGoOfEverything) {
    Rules rules = settlingRules(HeightField(40, 30, 1.0));
    rules.tuning.startThreshold = rules.tuning.threshold * 5 / 4;
    for (const auto& [slope, moves] : {std::pair{1.2, false}, {1.3, true}}) {
        HeightField field = oracles::fieldOf(40, 30, [steep = slope](double x, double) { return steep * x; });
        const HeightField start = field;
        settleAndCheck(field, rules);
        EXPECT_EQ(sameHeights(field, start), !moves);
        if (moves) {
            expectAtRest(field, settlingRules(field));
        }
    }
}

// O5: a plane steeper than the talus turns about its centroid.
TEST(Settle, SteepPlaneTurnsAboutItsCentroid) {
    const oracles::TiltedPlane plane(96, 3);
    HeightField field = oracles::fieldOf(96, 40, [&](double x, double) { return plane.start(x); });
    settleAndCheck(field, settlingRules(field));
    const auto expected = oracles::sampled(96, 40, [&](double x, double) { return plane.rest(x); });
    // The iteration stops at a gap of 1e-5 of the squared change. The pile is therefore within the root of 2e-5 of the
    // change. The mean change is 55 cells, and the pile is 144 cells high.
    EXPECT_LE(oracles::distance(field, expected).misplaced, 0.0017);
}

// O4: slopes rise from a ring of cells at height 0, half a cell beyond the field's edge. Along its diagonals, the roof
// of the table has a kink. A quad averages over it: half a cell on one cell in N/4.
TEST(Settle, OpenTableKeepsItsRoof) {
    const int n = 64;
    const oracles::OpenTable table(n, n);
    HeightField field = oracles::fieldOf(n, n, [](double, double) { return 60; });
    Rules rules = settlingRules(field);
    rules.rim = sand::Rim::open;
    const sand::grid::Settled settled = settleAndCheck(field, rules);
    EXPECT_GT(settled.iterations, 0);
    EXPECT_GT(settled.outflow, 0);
    const auto expected = oracles::sampled(n, n, [&](double x, double y) { return table.rest(x, y); });
    EXPECT_LE(oracles::distance(field, expected).misplaced, 0.02);
}

TEST(Settle, RoughFieldsKeepVolumeAndExtremes) {
    std::mt19937 random(23);
    for (const auto rim : {sand::Rim::closed, sand::Rim::open}) {
        HeightField field = samples::randomField(67, 45, 1 << 21, random);
        Rules rules = settlingRules(field);
        rules.rim = rim;
        settleAndCheck(field, rules);
    }
}

// Stiff cases: spikes of the largest height, a pit, a chequerboard, sides of one cell, angle 0.
TEST(Settle, EndsWithSpikesOfEitherSign) {
    for (const auto& [columns, rows] : {std::pair{1, 1}, {1, 40}, {40, 1}, {2, 2}, {31, 33}}) {
        for (const int sign : {-1, 1}) {
            HeightField field(columns, rows, 1.0);
            field.setHeight(columns / 2, rows / 2, sign * sand::kMaxHeight);
            settleAndCheck(field, settlingRules(field, 1 << 20));
        }
    }
}

TEST(Settle, ChequerboardComesToRest) {
    HeightField field(32, 31, 1.0);
    for (int y = 0; y < 31; ++y) {
        for (int x = 0; x < 32; ++x) {
            field.setHeight(x, y, (x + y) % 2 == 0 ? sand::kMaxHeight : -sand::kMaxHeight);
        }
    }
    settleAndCheck(field, settlingRules(field));
}

/// Fields with the greatest differences: halves, a chequerboard, a spike, a pit, noise, and halves of one row.
std::vector<HeightField> extremeFields() {
    constexpr std::int32_t kMost = sand::kMaxHeight;
    std::mt19937 random(5);
    std::vector<HeightField> fields(5, HeightField(48, 40, 1.0));
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 48; ++x) {
            fields[0].setHeight(x, y, x < 24 ? kMost : -kMost);
            fields[1].setHeight(x, y, (x + y) % 2 == 0 ? kMost : -kMost);
            fields[2].setHeight(x, y, x == 20 && y == 20 ? kMost : -kMost);
            fields[3].setHeight(x, y, x == 0 && y == 0 ? -kMost : kMost);
            fields[4].setHeight(x, y, static_cast<std::int32_t>(random() % (2U * kMost + 1)) - kMost);
        }
    }
    fields.emplace_back(64, 1, 1.0);
    for (int x = 0; x < 64; ++x) {
        fields.back().setHeight(x, 0, x < 32 ? kMost : -kMost);
    }
    return fields;
}

TEST(Settle, EndsAtItsLimitWithSandThatSweepsBringToRest) {
    std::size_t number = 0;
    for (const HeightField& start : extremeFields()) {
        SCOPED_TRACE(number++);
        const Rules rules = settlingRules(start);
        const auto [least, greatest] = extremes(start);
        bool ended = false;
        for (std::int64_t work = 1000; !ended; work *= 100) {
            HeightField field = start;
            sand::WorkLimit limit(work);
            const auto settled = sand::grid::settle(field, rules, nullptr, base::fastestCodePath(), &limit);
            ended = settled.atRest;
            EXPECT_EQ(limit.reached(), !settled.atRest) << work;
            EXPECT_TRUE(work > 1000 || settled.iterations + settled.sweeps == 0) << "one of them takes more";
            EXPECT_EQ(field.volume(), start.volume()) << work;
            const auto [low, high] = extremes(field);
            EXPECT_GE(low, least) << work;
            EXPECT_LE(high, greatest) << work;
            sand::grid::Erosion erosion(field, rules);
            erosion.sweep(field, 100'000);
            EXPECT_TRUE(erosion.settled()) << work;
        }
    }
}

TEST(Settle, WithinItsLimitIsAsWithoutOne) {
    HeightField field = samples::cylinder(64, 16, 24), other = field;
    const Rules rules = settlingRules(field);
    const auto free = sand::grid::settle(field, rules);
    constexpr std::int64_t kMuch = 1'000'000'000;
    sand::WorkLimit limit(kMuch);
    const auto limited = sand::grid::settle(other, rules, nullptr, base::fastestCodePath(), &limit);
    EXPECT_TRUE(sameHeights(field, other));
    EXPECT_EQ(limited.iterations, free.iterations);
    EXPECT_EQ(limited.sweeps, free.sweeps);
    const std::int64_t used = kMuch - limit.left();
    EXPECT_GT(used, 4 * 64 * 64) << "at least an iteration";
    // With one cell less than it takes, it does not come to rest.
    HeightField short1 = samples::cylinder(64, 16, 24);
    sand::WorkLimit less(used - 1);
    EXPECT_FALSE(sand::grid::settle(short1, rules, nullptr, base::fastestCodePath(), &less).atRest);
}

TEST(Settle, AngleZeroComesToRest) {
    std::mt19937 random(19);
    HeightField field = samples::randomField(16, 16, 1 << 16, random);
    settleAndCheck(field, settlingRules(field, 0));
    const auto [least, greatest] = extremes(field);
    EXPECT_LE(greatest - least, 4 * 30) << "4 units for each of 30 faces from corner to corner";
}

TEST(Settle, SandBelowAnOpenRimIsSwept) {
    HeightField field(30, 30, 1.0);
    field.setHeight(15, 15, -40 * sand::kUnitsPerCell);
    Rules rules = settlingRules(field);
    rules.rim = sand::Rim::open;
    const sand::grid::Settled settled = settleAndCheck(field, rules);
    EXPECT_EQ(settled.iterations, 0);
    EXPECT_GT(settled.sweeps, 0);
}

// Cells twice as long as wide. One prism must rest in the same way along both axes.
TEST(Settle, LongCellsRestAtTheTalusAlongBothAxes) {
    const oracles::Prism pile(16, 16);
    Rules rules = settlingRules(HeightField(8, 64, 1.0));
    rules.aspect = 2 * sand::kUnitsPerCell;
    HeightField field = oracles::fieldOf(8, 64, [&](double, double y) { return pile.start(2 * y - 64); });
    settleAndCheck(field, rules);
    const auto expected = oracles::sampled(8, 64, [&](double, double y) { return pile.rest(2 * y - 64); });
    EXPECT_LE(oracles::distance(field, expected).misplaced, 0.01);  // the bound for 64 square cells, O2
}

TEST(Settle, InstructionSetChangesNothing) {
    std::mt19937 random(29);
    const HeightField start = samples::randomField(61, 47, 1 << 21, random);
    HeightField automatic = start;
    HeightField baseline = start;
    const Rules rules = settlingRules(start);
    sand::grid::settle(automatic, rules);
    sand::grid::settle(baseline, rules, nullptr, base::CodePath::baseline);
    EXPECT_TRUE(sameHeights(automatic, baseline));
}

}  // namespace
