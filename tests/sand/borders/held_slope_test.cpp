// SPDX-License-Identifier: Apache-2.0
// A tool that is held on a slope is an obstacle like a wall. The sand comes to rest around it, and no slope runs past
// it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/support/borders/border_experiments.hpp"
#include "tests/support/borders/tool_kinds.hpp"
#include "tests/support/seed.hpp"

namespace {

using borders::Case;
using borders::Hand;
using enum sand::ToolKind;

struct HeldSlope {
    double ranPast = 0;  // volume that moved after the press had ended [cell³]
    bool atRest = false;
};

constexpr int kSecond = 60;  // [step]

/// Presses a tool of 6 cells into a slope along `degrees` until its centre is `higher` cells above the sand. Holds it
/// for 30 s. The first `pressing` steps do not count.
HeldSlope holdOnSlope(const borders::Ground& ground, sand::ToolKind kind, double slope, double degrees, double band,
                      double higher, int pressing) {
    constexpr int n = 96;
    Case given = borders::caseOf(ground, n);
    given.tool = kind;
    given.radius = 6;
    given.sweeps = 16;
    given.start = given.talus * (1 + band);
    const double east = slope * std::cos(degrees / 57.29578), north = slope * std::sin(degrees / 57.29578);
    given.height = [=](double x, double y) { return 5 + east * x + north * y; };
    sand::Replica sand(borders::sceneOf(given));
    Hand hand(sand);
    hand.rest();
    hand.press(n / 2.0 + 0.3, n / 2.0 + 0.2, borders::heightAt(sand, n / 2.0, n / 2.0) + higher);
    for (int i = 0; i < pressing; ++i) {
        hand.hold();
    }
    const std::vector<double> pressed = borders::heightsOf(sand);
    for (int i = 0; i < 30 * kSecond && !sand.settled(); ++i) {
        hand.hold();
    }
    return {borders::moved(pressed, borders::heightsOf(sand)), sand.settled()};
}

// A wall in the tool's place lets 1.6 cell³ run past. Before steps counted only the room in their lower cell, a circle
// let 578 cell³ run past within 15 s, and did not come to rest.
TEST(HeldOnSlope, EveryToolRestsAndLetsNoSlopeRunPast) {
    for (const sand::ToolKind kind : support::everyTool()) {
        for (const double slope : {0.3, 0.62, 0.67}) {
            for (const double degrees : {0.0, 20.0, 45.0}) {
                const HeldSlope held = holdOnSlope(borders::kGrid, kind, slope, degrees, 0, 0, kSecond);
                const std::string name(base::nameOf(kind));
                EXPECT_TRUE(held.atRest) << name << ", slope " << slope << " along " << degrees;
                EXPECT_LT(held.ranPast, 2) << name << ", slope " << slope << " along " << degrees;
            }
        }
    }
}

TEST(HeldOnSlope, RestsWithAnyBand) {
    for (const double band : {0.001, 0.2}) {
        const HeldSlope held = holdOnSlope(borders::kGrid, circle, 0.67, 0, band, 0, kSecond);
        EXPECT_TRUE(held.atRest) << "band " << band;
        EXPECT_LT(held.ranPast, 2) << "band " << band;
    }
}

// On a TIN the sand that a press has thrown up slides for up to four seconds. A bowl that sand touches on one side
// alone leaves a little room below it elsewhere. Before a corner with room leaned on the tool, up to 137 cell³ ran past
// there.
TEST(HeldOnSlope, OfAFineTinLetsNoSlopeRunPast) {
    for (const sand::ToolKind kind : {circle, sphere, ellipsoid}) {
        for (const double higher : {0.0, 2.0, 4.0, 5.0}) {
            const HeldSlope held = holdOnSlope(borders::kTin, kind, 0.67, 0, 0, higher, 4 * kSecond);
            const auto scene = fmt::format("{}, {} cells above the sand", base::nameOf(kind), higher);
            fmt::print("{}: {:.1f} cell3\n", scene, held.ranPast);  // docs/sand.md
            EXPECT_TRUE(held.atRest) << scene;
            const double most = kind == circle ? 8 : higher == 0 ? 3 : 1;  // [cell³]
            EXPECT_LT(held.ranPast, most) << scene;
        }
    }
}

// Beside a tool, small triangles meet the large ones of a coarse mesh. While limits and momentum were those of edges,
// the sand that a press had thrown up dug pits there, and the slope above followed.
TEST(HeldOnSlope, OfACoarseTinRestsAndLetsNoSlopeRunPast) {
    double most = 0;  // [cell³]
    for (const sand::ToolKind kind : {circle, sphere, ellipsoid}) {
        for (const double slope : {0.62, 0.67}) {
            for (const double degrees : {0.0, 20.0, 45.0}) {
                for (const double higher : {0.0, 4.0}) {
                    const HeldSlope held = holdOnSlope(borders::kCoarse, kind, slope, degrees, 0, higher, 4 * kSecond);
                    const auto scene = fmt::format("{}, {} cells above a slope of {} along {}", base::nameOf(kind),
                                                   higher, slope, degrees);
                    most = std::max(most, held.ranPast);
                    EXPECT_TRUE(held.atRest) << scene;
                    EXPECT_LT(held.ranPast, 6) << scene;
                }
            }
        }
    }
    fmt::print("at most {:.1f} cell3\n", most);  // docs/limits.md
}

/// Returns the number of sweeps until level sand rests around a tool that is pressed a radius deep.
int sweepsToRest(sand::ToolKind kind, double radius) {
    const int n = static_cast<int>(8 * radius);
    constexpr int kMost = 2000;
    Case given = borders::caseOf(borders::kGrid, n);
    given.tool = kind;
    given.radius = radius;
    given.sweeps = 1;
    given.height = [=](double, double) { return 4 * radius; };
    sand::Replica sand(borders::sceneOf(given));
    Hand hand(sand);
    hand.rest();
    hand.press(n / 2.0 + 0.3, n / 2.0 + 0.2, 4 * radius);
    int sweeps = 1;
    while (sweeps < kMost && !sand.settled()) {
        hand.hold();
        ++sweeps;
    }
    return sweeps;
}

// Sand beside the outline used to run along it without end: more than 9000 sweeps for a sphere of 12 cells.
TEST(HeldOnSlope, LevelSandRestsSoonAroundATool) {
    for (const sand::ToolKind kind : {sphere, circle, ellipsoid}) {
        EXPECT_LE(sweepsToRest(kind, 6), 200) << base::nameOf(kind);
        EXPECT_LE(sweepsToRest(kind, 12), 200) << base::nameOf(kind);
    }
    EXPECT_LE(sweepsToRest(sphere, 30), 600);
}

/// Returns the lowest place of a circle's centre over (x, y) at which it cuts no sand.
sand::ProbePoint lowestPlace(const sand::Replica& sand, double x, double y, double radius, int n) {
    double highest = 0;
    for (int row = 0; row < n; ++row) {
        for (int column = 0; column < n; ++column) {
            if (std::hypot(column + 0.5 - x, row + 0.5 - y) <= radius + 0.1) {
                highest = std::max(highest, borders::heightAt(sand, column + 0.5, row + 0.5));
            }
        }
    }
    return borders::probeAt(x, y, highest + radius + 1.0 / 128);
}

// Two opposite steps beside a face cancel each other. A tool that limits one of them makes the face steeper, although
// it cuts nothing. A replica visits only the blocks that something has woken, and must find that. A replica that joins
// before each step looks at all blocks.
TEST(HeldOnSlope, AnArrivingToolWakesTheSandThatItReaches) {
    std::mt19937 random(test::randomSeed());
    constexpr int n = 48;
    int moved = 0;
    for (int trial = 0; trial < 20; ++trial) {
        Case given = borders::caseOf(borders::kGrid, n);
        given.tool = circle;
        given.radius = 3;
        given.height = [&](double, double) { return 10 + static_cast<double>(random() % 1000) / 50; };
        sand::Replica sand(borders::sceneOf(given)), joining(borders::sceneOf(given));
        Hand(sand).rest();
        std::uint64_t number = sand.stepNumber();
        for (int i = 0; i < 40; ++i) {
            const auto place = [&random] { return 4 + static_cast<double>(random() % (256 * (n - 8))) / 256; };
            const sand::ProbePoint above = lowestPlace(sand, place(), place(), given.radius, n);
            const std::vector<double> heights = borders::heightsOf(sand);
            for (const bool engaged : {true, true, false}) {
                const sand::Step step{.epoch = 1, .number = ++number, .engaged = engaged, .path = {above}};
                joining.decodeState(sand.encodeState());
                sand.apply(step);
                joining.apply(step);
                ASSERT_EQ(joining.stateHash(), sand.stateHash()) << "trial " << trial << ", step " << number;
            }
            moved += borders::heightsOf(sand) != heights ? 1 : 0;
        }
    }
    EXPECT_GT(moved, 0) << "the test needs tools that move sand";
}

/// Returns the share of a thin layer that stays on a plane of rock. Its slope is `steep` times the talus along
/// `degrees`.
double staysOnRock(double steep, double degrees) {
    constexpr int n = 64;
    constexpr double kThick = 0.4;  // [cell]
    Case given = borders::caseOf(borders::kGrid, n);
    given.rim = sand::Rim::open;
    given.sweeps = 64;
    const double slope = steep * borders::kTalus;
    const double east = slope * std::cos(degrees / 57.29578), north = slope * std::sin(degrees / 57.29578);
    given.rock = [=](double x, double y) { return 1 + east * x + north * y; };
    given.height = [=](double x, double y) { return 1 + kThick + east * x + north * y; };
    sand::Replica sand(borders::sceneOf(given));
    EXPECT_TRUE(Hand(sand).rest());
    double left = 0;
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
            left += borders::heightAt(sand, x + 0.5, y + 0.5) - given.rock(x + 0.5, y + 0.5);
        }
    }
    return left / (kThick * n * n);
}

// A step that counted only the sand of its upper cell kept 98 % of such a layer on a diagonal slope.
TEST(ThinSand, SlidesOffRockInEveryDirection) {
    for (const double steep : {1.1, 1.3, 2.0}) {
        for (const double degrees : {0.0, 20.0, 30.0, 40.0, 45.0}) {
            EXPECT_LT(staysOnRock(steep, degrees), 0.005) << steep << " of the talus along " << degrees;
        }
    }
}

// Three units of dust on a cliff have almost nothing to give. They must not make stable sand beside the cliff slide.
TEST(ThinSand, OfDustOnACliffMovesNoStableSandBesideIt) {
    constexpr int n = 32, kCliff = 12;
    constexpr double kDust = 3.0 / sand::kUnitsPerCell, kHigh = 4000;  // [cell]
    Case given = borders::caseOf(borders::kGrid, n);
    given.rock = [=](double x, double) { return x < kCliff ? kHigh : 0; };
    given.height = [=](double x, double y) { return x < kCliff ? kHigh + kDust : 5 + 0.9 * borders::kTalus * y; };
    sand::Replica sand(borders::sceneOf(given));
    const std::vector<double> before = borders::heightsOf(sand);
    ASSERT_TRUE(Hand(sand).rest());
    const std::vector<double> after = borders::heightsOf(sand);
    for (std::size_t i = 0; i < after.size(); ++i) {
        if (i % n >= kCliff) {
            ASSERT_NEAR(after[i], before[i], kCliff * n * kDust) << "at cell " << i;
        }
    }
}

}  // namespace
