// SPDX-License-Identifier: Apache-2.0
#include "sand/certificate.hpp"

#include <gtest/gtest.h>

#include <random>

#include "sand/settle.hpp"
#include "tests/support/reference_sweep.hpp"
#include "tests/support/sand_samples.hpp"
#include "tests/support/tight_projection.hpp"

namespace {

using sand::Certificate;
using sand::HeightField;

sand::Rules certifiedRules(const HeightField& field) {
    sand::Rules rules;
    rules.columns = field.columns();
    rules.rows = field.rows();
    rules.threshold = rules.startThreshold = sand::kUnitsPerCell;
    return rules;
}

void expectFluxesLeadTo(const HeightField& start, const HeightField& rest, const sand::NetFlux& flux) {
    for (int y = 0; y < start.rows(); ++y) {
        for (int x = 0; x < start.columns(); ++x) {
            ASSERT_EQ(start.height(x, y) + flux.rise(x, y), rest.height(x, y)) << x << ", " << y;
        }
    }
}

template <class Law>
Certificate certificateOfSweeps(const HeightField& start, HeightField& rest, Law law) {
    const sand::NetFlux flux = reference::relax(rest, sand::kUnitsPerCell, law);
    expectFluxesLeadTo(start, rest, flux);
    return certify(start, rest, flux, certifiedRules(start));
}

// The theorem itself, on data for which no pile is "the" right one.
TEST(Certificate, HoldsOnRoughFields) {
    constexpr unsigned kSeed = 31;
    std::mt19937 random(kSeed);
    for (int run = 0; run < 6; ++run) {
        const HeightField start = samples::randomField(21, 17, (4 + 6 * run) * sand::kUnitsPerCell, random);
        for (const bool fourNeighbours : {false, true}) {
            HeightField rest = start;
            const Certificate certificate = fourNeighbours
                                                ? certificateOfSweeps(start, rest, reference::FourNeighbours())
                                                : certificateOfSweeps(start, rest, reference::Isotropic());
            reference::TightProjection projection(start, certificate.steepest);
            ASSERT_TRUE(projection.solve()) << "run " << run << " of seed " << kSeed;
            const double distance = projection.squaredDistanceTo(rest);
            EXPECT_LE(distance, certificate.squaredDistance) << "run " << run << " of seed " << kSeed;
            EXPECT_GT(distance, 0);
        }
    }
}

template <class Law>
Certificate certificateOfCylinder(int n, Law law) {
    const HeightField start = samples::cylinder(n, 0.25 * n, 0.15 * n);
    HeightField rest = start;
    return certificateOfSweeps(start, rest, law);
}

// A prototype measured 1.0 % at N = 64, 0.24 % at 128: a quarter at each halving of the cells. The bound allows every
// quad the slope of the steepest, which lies at the kink around the top, and so stays at 3 %.
TEST(Certificate, GapOfPlainSweepsShrinksWithTheCells) {
    const Certificate coarse = certificateOfCylinder(32, reference::Isotropic());
    const Certificate middle = certificateOfCylinder(64, reference::Isotropic());
    const Certificate fine = certificateOfCylinder(128, reference::Isotropic());
    EXPECT_LE(middle.relativeGap(), 0.010);
    EXPECT_LE(fine.relativeGap(), 0.0024);
    EXPECT_LE(middle.relativeGap(), 0.3 * coarse.relativeGap());
    EXPECT_LE(fine.relativeGap(), 0.3 * middle.relativeGap());
    EXPECT_GT(fine.relativeGap(), 0);
    EXPECT_LE(fine.relative(), 0.05);
    EXPECT_LE(fine.steepest, 1.07 * sand::kUnitsPerCell);
}

// N4 rests in a wrong pile at every cell size, along the diagonals too steep by the root of two, and its certificate
// says so: the bound stays large, and the gap is no gap, since it lies below zero and stays there.
TEST(Certificate, FailsOnThePileOfFourNeighbours) {
    const Certificate coarse = certificateOfCylinder(64, reference::FourNeighbours());
    const Certificate fine = certificateOfCylinder(128, reference::FourNeighbours());
    EXPECT_GE(coarse.relative(), 0.15);
    EXPECT_GE(fine.relative(), 0.15);
    EXPECT_LE(coarse.relativeGap(), -0.02);
    EXPECT_LE(fine.relativeGap(), -0.02);
    EXPECT_GE(fine.steepest, 1.4 * sand::kUnitsPerCell);
}

TEST(Certificate, OfAFieldAtRestIsZero) {
    const HeightField flat(9, 7, 1.0);
    const Certificate certificate = certify(flat, flat, sand::NetFlux(9, 7), certifiedRules(flat));
    EXPECT_EQ(certificate.squaredDistance, 0);
    EXPECT_EQ(certificate.relative(), 0);
    EXPECT_EQ(certificate.steepest, sand::kUnitsPerCell);
}

}  // namespace
