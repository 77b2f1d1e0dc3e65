// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "sand/tin/flow/erosion.hpp"
#include "tests/support/tin_piles.hpp"

namespace active_mesh {
namespace {

using namespace tin_piles;
using sand::tin::ActiveMesh;

constexpr std::int32_t kTalus = 65536;  // [unit per cell], 45 degrees

/// All of a layer, by its own numbers.
ActiveMesh everythingOf(const VertexSand& layer, bool obstacle, ActiveMesh sand) {
    const sand::tin::Triangles& mesh = layer.triangles();
    const sand::tin::Slopes slopes = sand::tin::slopesOf(kTalus, kTalus * 5 / 4);
    sand::tin::Weights weights;
    for (std::size_t i = 0; i < mesh.places.size(); ++i) {
        const bool under = obstacle && mesh.places[i].x < 8 * kCell;
        sand.addVertex(layer.volumes()[i], layer.stars()[i], under ? 2 * kTalus : ActiveMesh::kFree);
    }
    const auto slots = static_cast<std::int32_t>(mesh.triangles.size());
    for (std::int32_t slot = 0; slot < slots; ++slot) {
        sand.addFacet(facetOf(mesh, slot, slopes));
    }
    for (std::int32_t slot = 0; slot < slots; ++slot) {
        for (int corner = 0; corner < 3; ++corner) {
            const sand::tin::TriangleSide side{slot, corner}, other = across(mesh, side);
            if (other.triangle < slot) {  // nobody's too
                sand.addEdge(weights.edge(mesh, layer.stars(), side, other));
            }
        }
    }
    return sand;
}

bool sweep(ActiveMesh& sand, bool held, bool band, double momentum) {
    static_cast<void>(sand.slide(held, band));  // its edges are all there
    return sand.move(held, momentum).moved;
}

std::vector<std::int64_t> volumesOf(const ActiveMesh& sand) {
    std::vector<std::int64_t> volumes(sand.vertexCount());
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        volumes[i] = sand.volume(i);
    }
    return volumes;
}

TEST(ActiveMesh, DoublesAndIntegersAndEveryCodePathMoveTheSameSand) {
    VertexSand layer = layerOf(Kind::random, 16);
    fill(layer, [](double x, double y) { return std::hypot(x - 8, y - 8) < 5 ? 12.0 : 0.0; });
    for (const bool held : {false, true}) {
        for (const bool band : {false, true}) {
            ActiveMesh doubles = everythingOf(layer, held, ActiveMesh(false));
            ActiveMesh integers = everythingOf(layer, held, ActiveMesh(false, true));
            ActiveMesh fast = everythingOf(layer, held, ActiveMesh(base::machineHasV3()));
            for (int done = 0; done < 200; ++done) {
                const double momentum = done % 40 < 20 ? 0 : 0.9;  // both while much moves
                const bool moved = sweep(doubles, held, band, momentum);
                ASSERT_EQ(sweep(integers, held, band, momentum), moved);
                ASSERT_EQ(sweep(fast, held, band, momentum), moved);
                ASSERT_EQ(volumesOf(integers), volumesOf(doubles)) << held << band << ", sweep " << done;
                ASSERT_EQ(volumesOf(fast), volumesOf(doubles)) << held << band << ", sweep " << done;
            }
            EXPECT_NE(volumesOf(doubles), layer.volumes()) << "nothing moved";
        }
    }
}

TEST(ActiveMesh, MomentumKeepsVolumeAndExtremesAndLowersTheEnergyInEverySweep) {
    VertexSand layer = layerOf(Kind::random, 16);
    std::mt19937 random(3);
    for (sand::tin::Vertex vertex = 0; vertex < layer.mesh().vertexCount(); ++vertex) {
        layer.setHeight(vertex, static_cast<std::int32_t>(random() % (40 * kTalus)));
    }
    const auto heights = [&layer](const ActiveMesh& sand) {
        std::vector<double> all(sand.vertexCount());
        for (std::size_t i = 0; i < all.size(); ++i) {
            all[i] = static_cast<double>(sand.volume(i)) / static_cast<double>(layer.stars()[i]);
        }
        return all;
    };
    for (const bool held : {false, true}) {
        ActiveMesh sand = everythingOf(layer, held, ActiveMesh());
        std::vector<double> before = heights(sand);
        const std::vector<std::int64_t> first = volumesOf(sand);
        const std::int64_t volume = std::accumulate(first.begin(), first.end(), std::int64_t{0});
        int sweeps = 0;
        while (sweep(sand, held, false, 0.9)) {
            const std::vector<std::int64_t> volumes = volumesOf(sand);
            ASSERT_EQ(std::accumulate(volumes.begin(), volumes.end(), std::int64_t{0}), volume) << "sweep " << sweeps;
            const std::vector<double> now = heights(sand);
            ASSERT_GE(std::ranges::min(now), std::ranges::min(before)) << "sweep " << sweeps;
            ASSERT_LE(std::ranges::max(now), std::ranges::max(before)) << "sweep " << sweeps;
            double fall = 0;  // of the sum of V²/star, as one sum: what is left of two would be their roundings
            for (std::size_t i = 0; i < now.size(); ++i) {
                fall += (before[i] - now[i]) * (before[i] + now[i]) * static_cast<double>(layer.stars()[i]);
            }
            ASSERT_GT(fall, 0) << "sweep " << sweeps;
            before = now;
            ASSERT_LT(++sweeps, 100'000) << "seed 3";
        }
        EXPECT_GT(sweeps, 100);
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
    EXPECT_TRUE(sweep(sand, false, false, 0));
    EXPECT_NE(sand.volume(1), volume);
    EXPECT_EQ(sand.volume(0) + sand.volume(1) + sand.volume(2), volume + 7);
}

}  // namespace
}  // namespace active_mesh
