// SPDX-License-Identifier: Apache-2.0
// The rules in common use must be implemented correctly. Otherwise the comparison is worthless.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bench/sand/baseline_schemes.hpp"
#include "bench/sand/integer_n4.hpp"
#include "bench/sand/piles.hpp"
#include "bench/sand/relaxations.hpp"
#include "tests/support/sand/reference_sweep.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using bench::BaselineScheme;
using bench::FloatField;

constexpr BaselineScheme kAll[]{BaselineScheme::inPlaceN4, BaselineScheme::jacobiN4, BaselineScheme::jacobiN8,
                                BaselineScheme::jacobiN8r2};

double volume(const FloatField& field) {
    double sum = 0;
    for (int y = 0; y < field.side; ++y) {
        for (int x = 0; x < field.side; ++x) {
            sum += field.row(y)[x];
        }
    }
    return sum;
}

TEST(Baselines, KeepVolumeButForRounding) {
    for (const BaselineScheme scheme : kAll) {
        FloatField field(33);
        FloatField scratch(33);
        field.row(16)[16] = 30;
        for (int i = 0; i < 20; ++i) {
            bench::baseline::sweep(scheme, 1, field, scratch);
        }
        EXPECT_NEAR(volume(field), 30, 30 * 20 * 1e-6);
    }
}

TEST(Baselines, LeaveSandAtTheTalusAlone) {
    for (const BaselineScheme scheme : kAll) {
        FloatField field(20);
        FloatField scratch(20);
        for (int y = 0; y < 20; ++y) {
            for (int x = 0; x < 20; ++x) {
                field.row(y)[x] = static_cast<float>(x);
            }
        }
        EXPECT_EQ(bench::baseline::sweep(scheme, 1, field, scratch), 0.0F);
    }
}

// A spike of height 9 at a talus of 1. The expected shares of its neighbours are computed by hand.
TEST(Baselines, MoveTheSharesOfTheirRules) {
    const auto spike = [](BaselineScheme scheme) {
        FloatField field(9);
        FloatField scratch(9);
        field.row(4)[4] = 9;
        bench::baseline::sweep(scheme, 1, field, scratch);
        return field;
    };
    const FloatField n4 = spike(BaselineScheme::jacobiN4);
    EXPECT_FLOAT_EQ(n4.row(4)[4], 9 - 4 * (9 - 1) / 4.0F);
    EXPECT_FLOAT_EQ(n4.row(4)[5], 2);
    EXPECT_FLOAT_EQ(n4.row(5)[5], 0);
    const FloatField n8 = spike(BaselineScheme::jacobiN8);
    EXPECT_FLOAT_EQ(n8.row(5)[5], 1);
    EXPECT_FLOAT_EQ(n8.row(5)[4], 1);
    const FloatField n8r2 = spike(BaselineScheme::jacobiN8r2);
    EXPECT_FLOAT_EQ(n8r2.row(5)[5], (9 - std::sqrt(2.0F)) / 8);
    EXPECT_FLOAT_EQ(n8r2.row(5)[4], 1);
    // In place, the face to the south comes first: 4 go south, and 5 are left in the spike. 2 of these go east, and
    // from there 0.5 continue east and 0.25 north. 3 are left in the spike: 1 goes west and 0.5 north.
    const FloatField inPlace = spike(BaselineScheme::inPlaceN4);
    EXPECT_FLOAT_EQ(inPlace.row(3)[4], 4);
    EXPECT_FLOAT_EQ(inPlace.row(4)[5], 1.25F);
    EXPECT_FLOAT_EQ(inPlace.row(4)[3], 1);
    EXPECT_FLOAT_EQ(inPlace.row(4)[4], 1.5F);
}

TEST(Baselines, AreTheSameInBothInstructionSets) {
    if (!base::machineHas(base::CodePath::v3)) {
        GTEST_SKIP() << "this machine has no x86-64-v3";
    }
    for (const BaselineScheme scheme : kAll) {
        FloatField a(37), b(37), scratch(37);
        for (int y = 10; y < 20; ++y) {
            std::fill_n(a.row(y) + 10, 12, 7.5F);
        }
        b.heights = a.heights;
        for (int i = 0; i < 30; ++i) {
            bench::baseline::sweep(scheme, 1, a, scratch);
            bench::v3::sweep(scheme, 1, b, scratch);
        }
        for (int y = 0; y < 37; ++y) {
            for (int x = 0; x < 37; ++x) {
                ASSERT_EQ(a.row(y)[x], b.row(y)[x]);
            }
        }
    }
}

// Compares sweeps with vectors and whole rows with sweeps from face to face.
TEST(Baselines, IntegerN4GivesWhatPlainSweepsGive) {
    std::mt19937 random(51);
    for (const auto& [columns, rows] : {std::pair{37, 23}, {1, 9}, {9, 1}, {1, 1}}) {
        const sand::HeightField start = samples::randomField(columns, rows, 8 * sand::kUnitsPerCell, random);
        sand::HeightField expected = start;
        const sand::grid::NetFlux expectedFlux =
            reference::relax(expected, sand::kUnitsPerCell, reference::FourNeighbours());
        for (const base::CodePath path : base::codePathsHere()) {
            bench::IntegerN4 n4(start, bench::rulesFor(start), path);
            sand::grid::NetFlux flux(columns, rows);
            for (int sweep = 0; sweep < 100000 && !n4.atRest(); ++sweep) {
                n4.sweep(1);
                n4.addFluxes(flux);
            }
            EXPECT_TRUE(n4.atRest());
            EXPECT_TRUE(sameHeights(n4.field(), expected)) << columns << " x " << rows;
            EXPECT_EQ(n4.field().volume(), start.volume());
            for (int y = 0; y < rows; ++y) {
                for (int x = 0; x < columns; ++x) {
                    ASSERT_EQ(flux.east(y)[x], expectedFlux.east(y)[x]) << x << ", " << y;
                    ASSERT_EQ(flux.north(y)[x], expectedFlux.north(y)[x]) << x << ", " << y;
                }
            }
        }
    }
}

TEST(Baselines, IntegerN4StartsBeyondTheBandAlone) {
    sand::HeightField field(8, 1, 1.0);
    field.setHeight(0, 0, sand::kUnitsPerCell + 6000);
    bench::IntegerN4 within(field, bench::rulesFor(field, 1, 0.1));
    within.sweep(9);
    EXPECT_TRUE(sameHeights(within.field(), field));
    EXPECT_EQ(within.sweepsDone(), 1) << "expected one sweep, which moves no sand";
    field.setHeight(0, 0, sand::kUnitsPerCell + 7002);
    bench::IntegerN4 beyond(field, bench::rulesFor(field, 1, 0.1));
    beyond.sweep(1);
    EXPECT_EQ(beyond.field().height(1, 0), 1751) << "expected a quarter of 7002, rounded up";
}

// The rules must rest in the same pile as the integer N4. Otherwise a comparison of error against time is meaningless.
TEST(Baselines, JacobiN4RestsInThePileOfTheIntegerN4) {
    const bench::Pile pile = bench::lowPile(32);
    std::vector<std::vector<double>> heights;
    for (const bench::Method& method : bench::methods({"N4", "float32 N4 Jacobi"})) {
        const auto relaxation = method.start(pile.start, bench::rulesFor(pile.start));
        relaxation->sweep(10000);
        ASSERT_TRUE(relaxation->atRest()) << method.name;
        heights.push_back(relaxation->heights());
    }
    // Rounding each flux up moves at most one unit per face and sweep. That is at most 4 x 200 sweeps / 2^16 = 1.2 % of
    // a cell.
    EXPECT_LE(bench::misplaced(heights[0], heights[1]), 1e-3);
}

}  // namespace
