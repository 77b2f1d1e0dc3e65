// SPDX-License-Identifier: Apache-2.0
// Cylinders, walls of sand and poured sand, on meshes of every kind and turned (oracles.hpp).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "sand/grid/settle.hpp"
#include "sand/model/height_field.hpp"
#include "sand/tin/flow/erosion.hpp"
#include "sand/tin/flow/settle.hpp"
#include "tests/support/sand/oracles.hpp"
#include "tests/support/sand/tin_piles.hpp"

namespace piles {
namespace {

using namespace tin_piles;
using oracles::Cylinder;

constexpr std::int32_t kTalus = 65536;  // [unit per cell], 45 degrees

/// Settles the sand, and expects that volume and extremes are kept.
void settleAll(VertexSand& layer) {
    const sand::tin::Wide volume = layer.volume();
    const Extremes before = extremesOf(layer);
    EXPECT_TRUE(sand::tin::settle(layer, kTalus, kTalus).atRest);
    EXPECT_TRUE(layer.volume() == volume);
    const Extremes after = extremesOf(layer);
    EXPECT_GE(after.lowest, before.lowest);
    EXPECT_LE(after.highest, before.highest);
}

/// Returns a cylinder in the middle of n x n cells, at rest.
VertexSand settledCylinder(Kind kind, int n, double degrees, const Cylinder& cylinder) {
    VertexSand layer = layerOf(kind, n, degrees);
    fill(layer, oracles::around(n / 2.0, n / 2.0, [&](double r) { return cylinder.start(r); }));
    settleAll(layer);
    return layer;
}

double misplacedOf(const VertexSand& layer, int n, const Cylinder& cylinder) {
    return misplaced(layer, oracles::around(n / 2.0, n / 2.0, [&](double r) { return cylinder.rest(r); }));
}

struct Case {
    Kind kind;
    double degrees;
    double low, lowFiner, tall;  // share misplaced on 64 x 64 and 128 x 128 cells, and by the cone on 64 x 64 cells
};

// Required for meshes of 4000 and 16,000 vertices: 2.4 % and 1.0 % on random ones, 1.7 % and 0.36 % on jittered ones.
// Measured: random 0.70 and 0.27 %, cone 1.57 %; jittered 0.50 and 0.131 %, cone 0.82 %; regular 0.49 and 0.155 %. The
// cone along the lattice of a regular mesh has 1.16 %, because all diagonals run one way. The bounds are a tenth above
// the measured figures.
constexpr std::array kCases{
    Case{Kind::regular, 0, 0.0054, 0.00171, 0.0128},   Case{Kind::regular, 22.5, 0.0052, 0.00171, 0.0105},
    Case{Kind::regular, 45, 0.0053, 0.00171, 0.0128},  Case{Kind::jittered, 0, 0.0055, 0.00144, 0.0090},
    Case{Kind::jittered, 30, 0.0055, 0.00144, 0.0090}, Case{Kind::random, 0, 0.0078, 0.0030, 0.0173}};

TEST(TinPile, CylindersBecomeFrustumAndConeOnMeshesOfEveryKind) {
    for (const Case& one : kCases) {
        const Cylinder low(16, 9.6), tall(9.6, 28.8);
        EXPECT_LE(misplacedOf(settledCylinder(one.kind, 64, one.degrees, low), 64, low), one.low)
            << "frustum, " << nameOf(one.kind) << " turned by " << one.degrees;
        EXPECT_LE(misplacedOf(settledCylinder(one.kind, 64, one.degrees, tall), 64, tall), one.tall)
            << "cone, " << nameOf(one.kind) << " turned by " << one.degrees;
    }
}

TEST(TinPile, FinerMeshesAreNearerToTheFrustum) {
    for (const Case& one : kCases) {
        if (one.degrees == 0) {
            const Cylinder low(32, 19.2);
            EXPECT_LE(misplacedOf(settledCylinder(one.kind, 128, one.degrees, low), 128, low), one.lowFiner)
                << nameOf(one.kind) << " turned by " << one.degrees;
        }
    }
}

// Required: 0.36 % and 0.13 % on jittered meshes of 16,000 and 65,000 vertices, and 1.0 % on random ones of 16,000.
// Measured: 0.299, 0.117 and 0.625 %.
TEST(TinPile, FinerMeshesAreNearerToTheCone) {
    struct Finer {
        Kind kind;
        int n;
        double most;
    };
    for (const auto& [kind, n, most] :
         {Finer{Kind::jittered, 128, 0.0033}, {Kind::jittered, 256, 0.0013}, {Kind::random, 128, 0.0069}}) {
        const Cylinder tall(0.15 * n, 0.45 * n);
        EXPECT_LE(misplacedOf(settledCylinder(kind, n, 0, tall), n, tall), most) << nameOf(kind) << ", " << n;
    }
}

// Inertia begins at zero in every step. If it continued across steps, piles would be less accurate.
TEST(TinPile, InertiaWithinStepsLeavesPilesNearlyAsRight) {
    const Cylinder tall(9.6, 28.8);
    const auto atRest = [&](Kind kind, int sweepsOfAStep) {
        VertexSand layer = layerOf(kind, 64);
        fill(layer, oracles::around(32, 32, [&](double r) { return tall.start(r); }));
        sand::tin::Erosion erosion(layer, kTalus, kTalus);
        std::vector<sand::tin::Vertex> moved;
        if (sweepsOfAStep == 0) {
            erosion.settle(layer, 1'000'000, moved);
        }
        for (int done = 0; done < 1'000'000 && !erosion.settled();) {
            done += erosion.sweep(layer, sweepsOfAStep, nullptr, moved);
        }
        EXPECT_TRUE(erosion.settled());
        return misplacedOf(layer, 64, tall);
    };
    for (const Kind kind : {Kind::jittered, Kind::random}) {
        const double without = atRest(kind, 0), inSteps = atRest(kind, 24), atOnce = atRest(kind, 1'000'000);
        std::printf("%s: without %.3f %%, in steps of 24 sweeps %.3f %%, in one step %.3f %%\n", nameOf(kind),
                    100 * without, 100 * inSteps, 100 * atOnce);
        EXPECT_LE(inSteps, 1.15 * without) << nameOf(kind);
        EXPECT_GT(atOnce, inSteps) << nameOf(kind);
    }
}

// A slope is rounded where it begins and where it ends. Each of the four kinks misplaces some area of the
// cross-section, whatever the size of the wall. Measured: 0.12 cell² on jittered meshes, 0.17 on regular and 0.42 on
// random ones.
TEST(TinPile, AWallOfSandBecomesItsRampInAnyDirection) {
    for (const auto& [kind, kink] : {std::pair{Kind::regular, 0.19}, {Kind::jittered, 0.135}, {Kind::random, 0.46}}) {
        for (const double degrees : {0.0, 22.5, 45.0}) {
            constexpr int kSide = 64;
            const oracles::Prism wall(0.12 * kSide, 0.1 * kSide);
            const oracles::Line line{kSide / 2.0, kSide / 2.0, degrees};
            const auto inTheMiddle = [&](double x, double y) { return std::abs(line.along(x, y)) < 0.15 * kSide; };
            VertexSand layer = layerOf(kind, kSide);
            fill(layer, [&](double x, double y) {
                return std::abs(line.along(x, y)) < 0.4 * kSide ? wall.start(line.across(x, y)) : 0;
            });
            settleAll(layer);
            EXPECT_LE(misplaced(
                          layer, [&](double x, double y) { return wall.rest(line.across(x, y)); }, inTheMiddle),
                      4 * kink / wall.area())
                << nameOf(kind) << ", " << degrees;
        }
    }
}

// A tool far smaller than a cell pours sand on one vertex. 64 sweeps follow each portion.
TEST(TinPile, PouredSandIsACone) {
    double coarser = 1;
    for (const int n : {32, 64}) {
        VertexSand layer = layerOf(Kind::jittered, n);
        const sand::tin::Vertex top = layer.insert({n * kCell / 2, n * kCell / 2});
        static_cast<void>(layer.takeChange());
        const double foot = 0.3 * n;
        const double volume = std::numbers::pi / 3 * foot * foot * foot;  // [cell³]
        sand::tin::Erosion erosion(layer, kTalus, kTalus);
        std::vector<sand::tin::Vertex> moved;
        constexpr int kPortions = 200;
        for (int i = 0; i < kPortions; ++i) {
            layer.add(top, static_cast<std::int64_t>(6.0 * kCell * kCell * kHeight * volume / kPortions));
            erosion.wake({top});
            erosion.sweep(layer, 64, nullptr, moved);
        }
        erosion.settle(layer, 1'000'000, moved);
        EXPECT_TRUE(erosion.settled());
        const oracles::PouredCone cone(volume);
        const double wrong =
            misplaced(layer, oracles::around(n / 2.0, n / 2.0, [&](double r) { return cone.rest(r); }));
        EXPECT_LE(wrong, 0.6 * coarser) << "does not converge, " << n;
        coarser = wrong;
    }
    EXPECT_LE(coarser, 0.0136);  // measured 1.23 %
}

/// Returns the share of the sand between two surfaces, from the heights at the cell centres.
double between(const VertexSand& one, const VertexSand& other, int n) {
    double sum = 0, all = 0;
    std::int32_t here = sand::tin::kNoNumber, there = sand::tin::kNoNumber;
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
            const LatticePoint place{x * kCell + kCell / 2, y * kCell + kCell / 2};
            const double height = heightAt(one, place, here);
            sum += std::abs(height - heightAt(other, place, there));
            all += height;
        }
    }
    return sum / all;
}

// On a grid this test would fail, because piles on a grid show its axes.
TEST(TinPile, TurningTheMeshChangesThePileByLessThanItsError) {
    constexpr int kSide = 64;
    const Cylinder cylinder(0.25 * kSide, 0.15 * kSide);
    const VertexSand straight = settledCylinder(Kind::jittered, kSide, 0, cylinder);
    const double error = misplacedOf(straight, kSide, cylinder);
    for (const double degrees : {9.0, 22.5, 45.0}) {
        EXPECT_LE(between(straight, settledCylinder(Kind::jittered, kSide, degrees, cylinder), kSide), error)
            << degrees;
    }
}

TEST(TinPile, TheSamePileOnGridAndTinAgrees) {
    constexpr int kSide = 64;
    const Cylinder cylinder(0.25 * kSide, 0.15 * kSide);
    const VertexSand layer = settledCylinder(Kind::jittered, kSide, 0, cylinder);
    sand::HeightField field = oracles::fieldOf(
        kSide, kSide, oracles::around(kSide / 2.0, kSide / 2.0, [&](double r) { return cylinder.start(r); }));
    sand::Rules rules;
    rules.columns = rules.rows = kSide;
    rules.tuning.threshold = rules.tuning.startThreshold = kTalus;
    sand::grid::settle(field, rules);
    double sum = 0, all = 0;
    std::int32_t triangle = sand::tin::kNoNumber;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const double height = field.height(x, y) / kHeight;
            sum += std::abs(height - heightAt(layer, {x * kCell + kCell / 2, y * kCell + kCell / 2}, triangle));
            all += height;
        }
    }
    EXPECT_LE(sum / all, 0.0051 + 0.003) << "more than the sum of the errors of grid and TIN";
}

}  // namespace
}  // namespace piles
