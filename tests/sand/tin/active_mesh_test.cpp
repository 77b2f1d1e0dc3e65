// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "sand/tin/flow/erosion.hpp"
#include "tests/support/sand/tin_piles.hpp"

namespace active_mesh {
namespace {

using namespace tin_piles;
using sand::tin::ActiveMesh;

constexpr std::int32_t kTalus = 65536;  // [unit per cell], 45 degrees

/// Adds the whole layer to `sand`, with the layer's own numbers. `open`: sand falls over the rim.
ActiveMesh everythingOf(const VertexSand& layer, bool obstacle, bool open, ActiveMesh sand) {
    const sand::tin::Triangles& mesh = layer.triangles();
    const sand::tin::Slopes slopes = sand::tin::slopesOf(kTalus, kTalus * 5 / 4);
    sand::tin::Weights weights;
    for (std::size_t i = 0; i < mesh.places.size(); ++i) {
        const bool under = obstacle && mesh.places[i].x < 8 * kCell;
        sand.addVertex(layer.volumes()[i], layer.stars()[i], under ? 2 * kTalus : ActiveMesh::kFree,
                       open && isOnRim(mesh, mesh.places[i]));
    }
    const auto slots = static_cast<std::int32_t>(mesh.triangles.size());
    for (std::int32_t slot = 0; slot < slots; ++slot) {
        sand.addFacet(facetOf(mesh, slot, slopes));
    }
    for (std::int32_t slot = 0; slot < slots; ++slot) {
        for (int corner = 0; corner < 3; ++corner) {
            const sand::tin::TriangleSide side{slot, corner}, other = across(mesh, side);
            if (other.triangle < slot) {  // smaller slots, and kNoNumber, so that each edge is added once
                sand.addEdge(weights.edge(mesh, layer.stars(), side, other));
            }
        }
    }
    return sand;
}

sand::tin::SweepResult sweep(ActiveMesh& sand, bool held, bool band, double momentum) {
    static_cast<void>(sand.slide(held, band, momentum));  // no facet lacks edges, so that the result is not needed
    return sand.move(held);
}

std::vector<std::int64_t> volumesOf(const ActiveMesh& sand) {
    std::vector<std::int64_t> volumes(sand.vertexCount());
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        volumes[i] = sand.volume(i);
    }
    return volumes;
}

void expectTheSameSand(const VertexSand& layer, bool held, bool band, bool open) {
    ActiveMesh doubles = everythingOf(layer, held, open, ActiveMesh(base::CodePath::baseline));
    ActiveMesh integers = everythingOf(layer, held, open, ActiveMesh(base::CodePath::baseline, true));
    ActiveMesh fast = everythingOf(layer, held, open, ActiveMesh(base::fastestCodePath()));
    std::int64_t fell = 0;
    for (int done = 0; done < 200; ++done) {
        const double momentum = done % 40 < 20 ? 0 : 0.9;  // with and without momentum while much sand moves
        const sand::tin::SweepResult result = sweep(doubles, held, band, momentum);
        for (ActiveMesh* other : {&integers, &fast}) {
            const sand::tin::SweepResult same = sweep(*other, held, band, momentum);
            ASSERT_EQ(same.moved, result.moved);
            ASSERT_EQ(same.outflow, result.outflow) << "sweep " << done;
            ASSERT_EQ(same.resting, result.resting) << "sweep " << done;
            ASSERT_EQ(volumesOf(*other), volumesOf(doubles)) << "sweep " << done;
        }
        fell += result.outflow;
    }
    EXPECT_NE(volumesOf(doubles), layer.volumes()) << "no sand moved";
    EXPECT_EQ(fell > 0, open);
}

TEST(ActiveMesh, DoublesAndIntegersAndEveryCodePathMoveTheSameSand) {
    VertexSand layer = layerOf(Kind::random, 16);
    fill(layer, [](double x, double y) { return std::hypot(x - 8, y - 8) < 5 ? 12.0 : 0.0; });
    for (const bool held : {false, true}) {
        for (const bool band : {false, true}) {
            for (const bool open : {false, true}) {
                SCOPED_TRACE(testing::Message() << "held " << held << ", band " << band << ", open " << open);
                expectTheSameSand(layer, held, band, open);
            }
        }
    }
}

// c of a triangle is 0.8 (m² - g²)/(m² + g²). At three taluses c is 0.64, and a share of 0.9 continues. At half a talus
// the slope adds -0.48, and 0.096 is left.
TEST(ActiveMesh, ATriangleThatIsFlatterThanTheTalusBrakesItsSlide) {
    constexpr std::int64_t talus = 1'000'000;
    const auto afterSliding = [](bool moving) {
        ActiveMesh sand;
        for (const std::int64_t volume : {3 * talus, std::int64_t{0}, std::int64_t{0}}) {
            sand.addVertex(volume, 1, ActiveMesh::kFree, false, true);
        }
        sand.setBare(static_cast<std::size_t>(sand.addFacet({.corner = {0, 1, 2}, .first = 1.0 / (talus * talus)})),
                     false);
        sand.addEdge({.from = 0, .to = 1, .leftFacet = 0, .rightFacet = 0, .left = 0.1});
        static_cast<void>(sweep(sand, false, false, 0.9));
        EXPECT_EQ(sand.volume(1), 192'000) << "0.1 of 0.64 of three taluses";
        sand.place(0, talus / 2, 1, ActiveMesh::kFree, moving);
        sand.place(1, 0, 1, ActiveMesh::kFree, moving);
        static_cast<void>(sweep(sand, false, false, 0.9));
        return sand.volume(1);
    };
    EXPECT_NEAR(static_cast<double>(afterSliding(true)), 0.1 * 0.096 * talus / 2, 1);
    EXPECT_EQ(afterSliding(false), 0) << "a slide must not continue where sand has stopped";
}

/// Returns the fall of V²/star from the volumes `before` to the volumes `after`. It is one sum of exact products over
/// the vertices, because the difference of two sums would be lost in their rounding.
long double fallOf(const VertexSand& layer, const std::vector<std::int64_t>& before,
                   const std::vector<std::int64_t>& after) {
    long double fall = 0;
    for (std::size_t i = 0; i < after.size(); ++i) {
        const sand::tin::Wide product = sand::tin::Wide{before[i] - after[i]} * (before[i] + after[i]);
        fall += static_cast<long double>(product) / static_cast<long double>(layer.stars()[i]);
    }
    return fall;
}

void expectTheProofsToHold(const VertexSand& layer, bool held, bool open) {
    const auto heights = [&layer](const ActiveMesh& sand) {
        std::vector<double> all(sand.vertexCount());
        for (std::size_t i = 0; i < all.size(); ++i) {
            all[i] = static_cast<double>(sand.volume(i)) / static_cast<double>(layer.stars()[i]);
        }
        return all;
    };
    ActiveMesh sand = everythingOf(layer, held, open, ActiveMesh());
    std::vector<double> before = heights(sand);
    std::vector<std::int64_t> last = volumesOf(sand);
    std::int64_t volume = std::accumulate(last.begin(), last.end(), std::int64_t{0});
    int sweeps = 0;
    for (;;) {
        const sand::tin::SweepResult result = sweep(sand, held, false, 0.9);
        if (!result.moved) {
            ASSERT_EQ(result.outflow, 0);
            break;
        }
        const std::vector<std::int64_t> volumes = volumesOf(sand);
        ASSERT_GE(result.outflow, 0) << "sweep " << sweeps;
        volume -= result.outflow;
        ASSERT_EQ(std::accumulate(volumes.begin(), volumes.end(), std::int64_t{0}), volume) << "sweep " << sweeps;
        const std::vector<double> now = heights(sand);
        const double lowest = std::ranges::min(before);
        ASSERT_GE(std::ranges::min(now), open ? std::min(lowest, 0.0) : lowest) << "sweep " << sweeps;
        ASSERT_LE(std::ranges::max(now), std::ranges::max(before)) << "sweep " << sweeps;
        ASSERT_GT(fallOf(layer, last, volumes), 0) << "sweep " << sweeps;
        before = now;
        last = volumes;
        ASSERT_LT(++sweeps, 100'000) << "seed 3";
    }
    EXPECT_GT(sweeps, 100);
}

TEST(ActiveMesh, MomentumKeepsVolumeAndExtremesAndLowersTheEnergyInEverySweep) {
    VertexSand layer = layerOf(Kind::random, 16);
    std::mt19937 random(3);
    for (sand::tin::Vertex vertex = 0; vertex < layer.mesh().vertexCount(); ++vertex) {
        layer.setHeight(vertex, static_cast<std::int32_t>(random() % (40 * kTalus)));
    }
    for (const bool held : {false, true}) {
        for (const bool open : {false, true}) {
            SCOPED_TRACE(testing::Message() << "held " << held << ", open " << open);
            expectTheProofsToHold(layer, held, open);
        }
    }
}

TEST(ActiveMesh, CountsInIntegersWhatDoublesWouldRound) {
    ActiveMesh sand;
    const std::int64_t star = std::int64_t{1} << 34, volume = (star << 20) + 1;  // an odd number beyond 2^53
    for (const std::int64_t each : {std::int64_t{0}, volume, std::int64_t{7}}) {
        sand.addVertex(each, star);
    }
    sand.addFacet({.corner = {0, 1, 2}, .first = 1, .mixed = 0, .second = 1});
    sand.addEdge({.from = 0, .to = 1, .leftFacet = 0, .rightFacet = 0, .left = 0.1 * static_cast<double>(star)});
    EXPECT_TRUE(sweep(sand, false, false, 0).moved);
    EXPECT_NE(sand.volume(1), volume);
    EXPECT_EQ(sand.volume(0) + sand.volume(1) + sand.volume(2), volume + 7);
}

}  // namespace
}  // namespace active_mesh
