// SPDX-License-Identifier: Apache-2.0
// Tools of any size at any place. A pose with NaN never becomes a step: the haptic side refuses it before quantising
// (tests/haptic_bridge/devices/device_test.cpp).
#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "sand/replica.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/sand/relaxing.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using sand::kProbePerCell;
using sand::ProbePoint;
using sand::Replica;
using sand::Rim;

ProbePoint probeAt(double column, double row, double height /* [cell] */) {
    return {static_cast<std::int32_t>(column * kProbePerCell), static_cast<std::int32_t>(row * kProbePerCell),
            static_cast<std::int32_t>(height * kProbePerCell)};
}

constexpr std::array kRims{Rim::closed, Rim::open};

scene::Scene sceneWith(double toolCells, Rim rim) {
    scene::Scene scene = samples::flatScene(45, 33, toolCells);
    scene.rules.rim = rim;
    return scene;
}

TEST(ExtremeTool, OutsideTheFieldItTouchesNothing) {
    for (const Rim rim : kRims) {
        const scene::Scene scene = sceneWith(4, rim);
        Replica replica(scene);
        std::uint64_t number = 0;
        for (const ProbePoint point :
             {probeAt(-4, 16, -1), probeAt(49, 16, -1), probeAt(20, -4, -1), probeAt(20, 37, -1), probeAt(20, 16, 4),
              ProbePoint{sand::kMaxProbe, -sand::kMaxProbe, 0},
              ProbePoint{-sand::kMaxProbe, sand::kMaxProbe, -sand::kMaxProbe}}) {
            replica.apply({1, ++number, false, {point}});
            replica.apply({1, ++number, true, {point}});
            EXPECT_TRUE(sameHeights(samples::fieldOf(replica), scene.terrain)) << "at " << point.x << ", " << point.y;
            replica.apply({1, ++number, false, {}});
        }
        EXPECT_EQ(replica.outflow(), 0);
    }
}

TEST(ExtremeTool, AtACornerAndOnTheRimsItLosesNothing) {
    for (const Rim rim : kRims) {
        for (const double radius : {0.6, 2.56, 8.0, 20.0}) {
            for (const ProbePoint point : {probeAt(0, 0, -1), probeAt(45, 33, -1), probeAt(0, 33, 0), probeAt(45, 0, 0),
                                           probeAt(22, 0, -2), probeAt(0, 16, -2), probeAt(44.5, 32.5, 0)}) {
                const scene::Scene scene = sceneWith(radius, rim);
                Replica replica(scene);
                for (std::uint64_t i = 1; i <= 200; ++i) {
                    replica.apply({1, i, i < 100, i == 1 ? std::vector{point} : std::vector<ProbePoint>{}});
                    ASSERT_EQ(samples::fieldOf(replica).volume() + replica.outflow(), 0)
                        << "radius " << radius << " at " << point.x << ", " << point.y << " in step " << i;
                }
                EXPECT_EQ(replica.outflow() == 0,
                          rim == Rim::closed || sameHeights(samples::fieldOf(replica), scene.terrain));
            }
        }
    }
}

TEST(ExtremeTool, LargerThanTheFieldItHasNowhereToPutTheSand) {
    const scene::Scene scene = sceneWith(2048, Rim::closed);
    Replica replica(scene);
    replica.apply({1, 1, true, {probeAt(22, 16, 2000)}});
    EXPECT_TRUE(sameHeights(samples::fieldOf(replica), scene.terrain)) << "it passes through the sand";
    Replica open(sceneWith(2048, Rim::open));
    open.apply({1, 1, true, {probeAt(22, 16, 2000)}});
    EXPECT_GT(open.outflow(), 0) << "over an open rim it clears the table";
    EXPECT_EQ(samples::fieldOf(open).volume() + open.outflow(), 0);
}

TEST(ExtremeTool, OfNoRadiusItDigsNothing) {
    const scene::Scene scene = sceneWith(0, Rim::closed);
    Replica replica(scene);
    replica.apply({1, 1, true, {probeAt(5.5, 5.5, -3), probeAt(40, 30, -3)}});
    EXPECT_TRUE(sameHeights(samples::fieldOf(replica), scene.terrain));
}

TEST(ExtremeTool, ThePapersOf256HundredthsDigsAFurrow) {
    Replica replica(sceneWith(2.56, Rim::closed));
    for (std::uint64_t i = 1; i <= 30; ++i) {
        replica.apply({1, i, true, {probeAt(8 + static_cast<double>(i), 16.5, 1)}});
    }
    EXPECT_LT(samples::fieldOf(replica).height(20, 16), -sand::kUnitsPerCell / 2);
    EXPECT_GT(samples::extremesOf(samples::fieldOf(replica)).highest, sand::kUnitsPerCell / 4);
    EXPECT_EQ(samples::fieldOf(replica).volume(), 0);
}

TEST(ExtremeTool, TeleportingItPloughsAllTheWay) {
    for (const Rim rim : kRims) {
        Replica replica(sceneWith(2.56, rim));
        replica.apply({1, 1, true, {probeAt(4, 16.5, 1)}});
        replica.apply({1, 2, true, {probeAt(40, 16.5, 1)}});
        for (const int column : {10, 20, 30}) {
            EXPECT_LT(samples::fieldOf(replica).height(column, 16), 0) << "no furrow at column " << column;
        }
        // From one end of the reachable range to the other, and back.
        replica.apply({1, 3, true, {{sand::kMaxProbe, sand::kMaxProbe, 0}, {-sand::kMaxProbe, -sand::kMaxProbe, 0}}});
        replica.apply({1, 4, true, {{sand::kMaxProbe, 16 * kProbePerCell, -sand::kMaxProbe}}});
        EXPECT_EQ(samples::fieldOf(replica).volume() + replica.outflow(), 0);
    }
}

TEST(ExtremeTool, HeldStillItLetsTheSweepsStop) {
    for (const double radius : {2.56, 8.0}) {
        for (const double height : {0.0, 1.0, -3.0}) {
            Replica replica(sceneWith(radius, Rim::closed));
            std::uint64_t number = 0;
            replica.apply({1, ++number, true, {probeAt(22.3, 16.1, height)}});
            for (int i = 0; i < 2000 && !replica.settled(); ++i) {
                replica.apply({1, ++number, true, {}});
            }
            ASSERT_TRUE(replica.settled()) << "a ball held still must not move sand forever";
            const std::int64_t sweeps = samples::erosionOf(replica).sweepsDone();
            (void)replica.stateHash();
            const auto tiles = replica.hashTiles().tileHashes();
            for (int i = 0; i < 100; ++i) {
                replica.apply({1, ++number, true, {}});
                (void)replica.stateHash();
                ASSERT_EQ(replica.hashTiles().tileHashes(), tiles) << "step " << number;
            }
            EXPECT_EQ(samples::erosionOf(replica).sweepsDone(), sweeps);
        }
    }
}

TEST(ExtremeTool, DiggingToBedrockStopsThere) {
    scene::Scene scene = sceneWith(6, Rim::closed);
    auto ground = std::make_shared<sand::Ground>(45, 33);
    for (int y = 0; y < 33; ++y) {
        for (int x = 0; x < 45; ++x) {
            ground->setBedrock(x, y, -2 * sand::kUnitsPerCell);
        }
    }
    scene.ground = ground;
    scene.rules.ground = ground->digest();
    Replica replica(scene);
    for (std::uint64_t i = 1; i <= 60; ++i) {
        replica.apply({1, i, true, {probeAt(10 + 0.4 * static_cast<double>(i), 16.5, 2)}});
        ASSERT_GE(samples::extremesOf(samples::fieldOf(replica)).lowest, -2 * sand::kUnitsPerCell) << "step " << i;
        ASSERT_EQ(samples::fieldOf(replica).volume(), 0);
    }
    EXPECT_EQ(samples::fieldOf(replica).height(34, 16), -2 * sand::kUnitsPerCell) << "bare rock under the tool";
}

}  // namespace
