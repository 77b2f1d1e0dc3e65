// SPDX-License-Identifier: Apache-2.0
// Sand on rock and beside walls at an open rim: it falls until nothing is left to fall, and takes no rock with it.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "sand/model/ground.hpp"
#include "tests/support/sand/relaxing.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace rock_rim {
namespace {

using samples::Law;
using samples::nameOf;
using sand::Ground;
using sand::HeightField;
using sand::kUnitsPerCell;

constexpr int kColumns = 37, kRows = 29;
constexpr int kMostSweeps = 20'000;

struct Result {
    std::int64_t outflow;
    bool settled;
};

/// Sweeps sand on `ground` under an open rim until it rests. Expects after every sweep that the volume has changed only
/// by the outflow, and that every layer has a thickness of at least 0.
Result settle(HeightField& field, const Ground& ground, const Law& law) {
    sand::Rules rules = samples::rulesFor(field, law);
    rules.rim = sand::Rim::open;
    sand::grid::Erosion erosion(field, rules, {.ground = &ground});
    const std::int64_t volume = field.volume();
    std::int64_t outflow = 0;
    for (int i = 0; i < kMostSweeps && !erosion.settled(); ++i) {
        const std::int64_t fell = erosion.sweep(field, 1);
        outflow += fell;
        EXPECT_GE(fell, 0) << "sand came in over the rim; " << nameOf(law);
        EXPECT_EQ(field.volume() + outflow, volume) << nameOf(law);
        for (int y = 0; y < kRows; ++y) {
            for (int x = 0; x < kColumns; ++x) {
                if (!ground.isWall(x, y) && ground.sand(x, y, field.height(x, y)) < 0) {
                    ADD_FAILURE() << "rock has worn away at " << x << ", " << y << ", sweep " << i << "; "
                                  << nameOf(law);
                    return {outflow, false};
                }
            }
        }
    }
    return {outflow, erosion.settled()};
}

bool isRim(int x, int y) { return x == 0 || y == 0 || x == kColumns - 1 || y == kRows - 1; }

/// Level sand, one cell thick, on a plateau of rock that is four cells high.
struct Plateau {
    HeightField field{kColumns, kRows, 1.0};
    Ground ground{kColumns, kRows};

    Plateau() {
        for (int y = 0; y < kRows; ++y) {
            for (int x = 0; x < kColumns; ++x) {
                ground.setBedrock(x, y, 4 * kUnitsPerCell);
                field.setHeight(x, y, 5 * kUnitsPerCell);
            }
        }
    }
};

// The ground beyond the rim has height 0, so that the rim of the plateau is a cliff. A face gives at most a quarter of
// the sand in a cell, so that up to three units stay.
TEST(RockRim, SandOfAPlateauFallsFromEverySideDownToTheRock) {
    for (const Law& law : samples::laws()) {
        Plateau plateau;
        const Result result = settle(plateau.field, plateau.ground, law);
        EXPECT_TRUE(result.settled) << nameOf(law);
        EXPECT_GT(result.outflow, 0) << nameOf(law);
        for (int y = 0; y < kRows; ++y) {
            for (int x = 0; x < kColumns; ++x) {
                if (isRim(x, y)) {
                    EXPECT_LE(plateau.ground.sand(x, y, plateau.field.height(x, y)), 3)
                        << nameOf(law) << " at " << x << ", " << y;
                }
            }
        }
        EXPECT_GT(plateau.ground.sand(kColumns / 2, kRows / 2, plateau.field.height(kColumns / 2, kRows / 2)),
                  kUnitsPerCell / 2)
            << nameOf(law) << ": the middle is level and far from the rim";
    }
}

TEST(RockRim, BareRockLosesNothingHoweverHighItIs) {
    std::mt19937 random(11);
    for (const Law& law : samples::laws()) {
        HeightField field = samples::randomField(kColumns, kRows, 20 * kUnitsPerCell, random);
        const HeightField rock = field;
        Ground ground(kColumns, kRows);
        for (int y = 0; y < kRows; ++y) {
            for (int x = 0; x < kColumns; ++x) {
                ground.setBedrock(x, y, field.height(x, y));
            }
        }
        EXPECT_EQ(settle(field, ground, law).outflow, 0) << nameOf(law);
        EXPECT_TRUE(sameHeights(field, rock)) << nameOf(law);
    }
}

TEST(RockRim, RoughSandOnRoughRockLosesSandAlone) {
    std::mt19937 random(12);
    for (const Law& law : samples::laws()) {
        HeightField field = samples::randomField(kColumns, kRows, 20 * kUnitsPerCell, random);
        Ground ground(kColumns, kRows);
        for (int y = 0; y < kRows; ++y) {
            for (int x = 0; x < kColumns; ++x) {
                ground.setBedrock(x, y, field.height(x, y) - static_cast<std::int32_t>(random() % kUnitsPerCell));
            }
        }
        EXPECT_GT(settle(field, ground, law).outflow, 0) << nameOf(law);
    }
}

TEST(RockRim, AWallOnTheRimLetsNoSandOut) {
    for (const Law& law : samples::laws()) {
        Plateau plateau;
        for (int y = 0; y < kRows; ++y) {
            for (int x = 0; x < kColumns; ++x) {
                if (isRim(x, y)) {
                    plateau.ground.setWall(x, y);
                }
            }
        }
        const HeightField before = plateau.field;
        EXPECT_EQ(settle(plateau.field, plateau.ground, law).outflow, 0) << nameOf(law);
        EXPECT_TRUE(sameHeights(plateau.field, before)) << nameOf(law);
    }
}

// Sand below the ground beyond the rim has nowhere to fall.
TEST(RockRim, SandBelowTheGroundBeyondTheRimStays) {
    for (const Law& law : samples::laws()) {
        Plateau hollow;
        for (int y = 0; y < kRows; ++y) {
            for (int x = 0; x < kColumns; ++x) {
                hollow.ground.setBedrock(x, y, -9 * kUnitsPerCell);
                hollow.field.setHeight(x, y, -2 * kUnitsPerCell);
            }
        }
        EXPECT_EQ(settle(hollow.field, hollow.ground, law).outflow, 0) << nameOf(law);
    }
}

}  // namespace
}  // namespace rock_rim
