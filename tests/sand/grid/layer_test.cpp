// SPDX-License-Identifier: Apache-2.0
// Sand over bedrock and beside walls as the sweeps see it: thin layers, cliffs, and stable sand that stays.
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "sand/model/ground.hpp"
#include "tests/support/relaxing.hpp"

namespace {

using samples::nameOf;
using sand::Ground;
using sand::HeightField;
using sand::Scheme;
using sand::grid::Erosion;

constexpr int kColumns = 37;
constexpr int kRows = 29;

/// Sand over a ground, ready to slide.
struct Layer {
    HeightField field{kColumns, kRows, 1.0};
    Ground ground{kColumns, kRows};

    void forEachCell(const std::function<void(int, int)>& task) const {
        for (int y = 0; y < kRows; ++y) {
            for (int x = 0; x < kColumns; ++x) {
                task(x, y);
            }
        }
    }
    [[nodiscard]] int thinnest() const {
        int result = 1 << 30;
        forEachCell([&](int x, int y) { result = std::min(result, ground.sand(x, y, field.height(x, y))); });
        return result;
    }
    [[nodiscard]] Erosion erosion(Scheme scheme) const {
        return {field, samples::rulesFor(field, scheme), {.ground = &ground}};
    }
};

/// Expects that nothing moves, whatever the scheme.
void expectStill(const Layer& start) {
    for (const Scheme scheme : samples::kSchemes) {
        Layer layer = start;
        Erosion erosion = layer.erosion(scheme);
        erosion.sweep(layer.field, 1000);
        EXPECT_TRUE(sameHeights(layer.field, start.field)) << nameOf(scheme);
        EXPECT_EQ(erosion.sweepsDone(), 1) << "the one sweep that finds nothing to do; " << nameOf(scheme);
    }
}

/// A ramp of 0.9 of the talus, which rises to the north.
std::int32_t ramp(int row) { return 58982 * row; }

// Without the rule for transverse differences this ramp lost 4.4 % and still moved after 100,000 sweeps.
TEST(Layer, AStableRampAlongAWallDoesNotMove) {
    for (const auto& isWall : std::initializer_list<std::function<bool(int, int)>>{
             [](int x, int) { return x < 4; },                            // along the western rim
             [](int x, int) { return x == 17; },                          // through the middle
             [](int x, int y) { return x == y; },                         // aslant
             [](int x, int y) { return x % 5 == 0 && y % 7 == 0; },       // single cells without data
             [](int x, int y) { return x == 36 || y == 28 || y == 0; }})  // along the rims
    {
        Layer layer;
        layer.forEachCell([&](int x, int y) {
            if (isWall(x, y)) {
                layer.ground.setWall(x, y);
            } else {
                layer.field.setHeight(x, y, ramp(y));
            }
        });
        expectStill(layer);
    }
}

TEST(Layer, AStableRampBesideBareRockDoesNotMove) {
    for (const int step : {20, 1000, -1}) {  // [cell], rock over the ramp
        Layer layer;
        layer.forEachCell([&](int x, int y) {
            const bool bare = x < 6 || x == 20;
            // Lower rock must leave the sand beside it stable: a gentle slope down to it.
            const std::int32_t height = step > 0 ? ramp(y) + step * sand::kUnitsPerCell : ramp(y) - 20000;
            layer.field.setHeight(x, y, bare ? height : ramp(y));
            layer.ground.setBedrock(x, y, bare ? height : ramp(y) - 5 * sand::kUnitsPerCell);
        });
        expectStill(layer);
    }
}

// What the two tests above guard against does happen where the cliff is sand.
TEST(Layer, TheSameCliffOfSandSlides) {
    Layer layer;
    layer.forEachCell(
        [&](int x, int y) { layer.field.setHeight(x, y, x < 6 ? ramp(y) + 20 * sand::kUnitsPerCell : ramp(y)); });
    Erosion erosion = layer.erosion(Scheme::isotropic);
    erosion.sweep(layer.field, 10);
    EXPECT_GT(layer.field.height(7, 14), ramp(14));
}

// A face gives at most a quarter of what lies there, rounded down: three units are too few to divide.
TEST(Layer, UpToThreeUnitsStayWhereverTheyLie) {
    std::mt19937 random(19);
    Layer layer;
    layer.forEachCell([&](int x, int y) {
        const std::int32_t rock = 3 * sand::kUnitsPerCell * x + static_cast<std::int32_t>(random() % 100000);
        layer.ground.setBedrock(x, y, rock);
        layer.field.setHeight(x, y, rock + static_cast<std::int32_t>(random() % 4));
    });
    expectStill(layer);
}

TEST(Layer, RockSteeperThanTheTalusKeepsNoMoreThanThat) {
    for (const Scheme scheme : samples::kSchemes) {
        std::mt19937 random(21);
        Layer layer;
        layer.forEachCell([&](int x, int y) {
            const std::int32_t rock = 3 * sand::kUnitsPerCell * x;
            layer.ground.setBedrock(x, y, rock);
            layer.field.setHeight(x, y, rock + static_cast<std::int32_t>(random() % 20000));
        });
        const std::int64_t volume = layer.field.volume();
        Erosion erosion = layer.erosion(scheme);
        for (int sweep = 0; sweep < 20000 && !erosion.settled(); ++sweep) {
            erosion.sweep(layer.field, 1);
            ASSERT_GE(layer.thinnest(), 0) << nameOf(scheme) << ", sweep " << sweep;
        }
        EXPECT_TRUE(erosion.settled()) << nameOf(scheme);
        EXPECT_EQ(layer.field.volume(), volume);
        layer.forEachCell([&](int x, int y) {
            if (x >= 3) {  // all of it together fills less than the three western columns
                EXPECT_LE(layer.ground.sand(x, y, layer.field.height(x, y)), 3)
                    << nameOf(scheme) << " " << x << " " << y;
            }
        });
    }
}

TEST(Layer, CliffsNeverMakeALayerThinnerThanNothing) {
    for (const Scheme scheme : samples::kSchemes) {
        for (std::uint32_t seed = 1; seed <= (samples::kSanitized ? 1U : 4U); ++seed) {
            std::mt19937 random(seed);
            Layer layer;
            layer.forEachCell([&](int x, int y) {
                const std::int32_t rock = random() % 3 == 0 ? static_cast<std::int32_t>(random() % (1U << 27)) : 0;
                layer.ground.setBedrock(x, y, rock);
                const std::uint32_t most = 1U << (random() % 25);
                layer.field.setHeight(x, y, rock + static_cast<std::int32_t>(random() % most));
                if (random() % 20 == 0) {
                    layer.ground.setWall(x, y);
                }
            });
            const HeightField start = layer.field;
            Erosion erosion = layer.erosion(scheme);
            for (int sweep = 0; sweep < 300; ++sweep) {
                erosion.sweep(layer.field, 1);
                ASSERT_GE(layer.thinnest(), 0) << nameOf(scheme) << ", sweep " << sweep << " of seed " << seed;
                ASSERT_EQ(layer.field.volume(), start.volume());
            }
            erosion.sweep(layer.field, 1000000);
            EXPECT_TRUE(erosion.settled()) << nameOf(scheme) << ", seed " << seed;
            EXPECT_GE(layer.thinnest(), 0);
            layer.forEachCell([&](int x, int y) {
                if (layer.ground.isWall(x, y)) {
                    EXPECT_EQ(layer.field.height(x, y), start.height(x, y)) << "a wall moved";
                }
            });
        }
    }
}

}  // namespace
