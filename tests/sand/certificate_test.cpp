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

sand::Rules rulesFor(const HeightField& field) {
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
    return certify(start, rest, flux, rulesFor(start));
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
double relativeOfCylinder(int n, Law law) {
    const HeightField start = samples::cylinder(n, 0.25 * n, 0.15 * n);
    HeightField rest = start;
    return certificateOfSweeps(start, rest, law).relative();
}

// NUMERICS: 1.0 % at N = 64, 0.24 % at 128.
TEST(Certificate, ShrinksWithTheCellsOfPlainSweeps) {
    const double coarse = relativeOfCylinder(32, reference::Isotropic());
    const double middle = relativeOfCylinder(64, reference::Isotropic());
    const double fine = relativeOfCylinder(128, reference::Isotropic());
    EXPECT_LE(middle, 0.012);
    EXPECT_LE(fine, 0.003);
    EXPECT_LE(middle, 0.5 * coarse);
    EXPECT_LE(fine, 0.5 * middle);
}

// N4 rests in a wrong pile, by the same 4 % of its sand at every cell size, and its certificate says so.
TEST(Certificate, FailsOnThePileOfFourNeighbours) {
    const double coarse = relativeOfCylinder(32, reference::FourNeighbours());
    const double fine = relativeOfCylinder(128, reference::FourNeighbours());
    EXPECT_GE(fine, 0.1);
    EXPECT_GE(fine, 0.7 * coarse);
}

TEST(Certificate, OfAFieldAtRestIsZero) {
    const HeightField flat(9, 7, 1.0);
    const Certificate certificate = certify(flat, flat, sand::NetFlux(9, 7), rulesFor(flat));
    EXPECT_EQ(certificate.squaredDistance, 0);
    EXPECT_EQ(certificate.relative(), 0);
    EXPECT_EQ(certificate.steepest, sand::kUnitsPerCell);
}

}  // namespace
