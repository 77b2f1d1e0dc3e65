// SPDX-License-Identifier: Apache-2.0
// The drawn surface of a TIN on the CPU depends only on the TIN, not on earlier TINs.
#include "render_node/tin/vertices.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scene/model/scene.hpp"
#include "shapes/tin/parts.hpp"
#include "tests/support/pictures/sample_tin.hpp"

namespace {

using render_node::TinChunk;
using render_node::TinVertices;
using sample::Tin;

/// Returns the corners of a chunk's triangles in order, and the ends of its parts.
std::pair<std::vector<std::array<Tin::Vertex, 3>>, std::vector<std::size_t>> orderOf(TinVertices& surface,
                                                                                     TinChunk& chunk) {
    (void)surface.settle(chunk);
    std::vector<std::array<Tin::Vertex, 3>> corners;
    for (const std::int32_t slot : chunk.slots) {
        corners.push_back(surface.triangles()[static_cast<std::size_t>(slot)].corner);
    }
    std::vector<std::size_t> ends;
    for (const TinChunk::Part& part : surface.partsOf(chunk)) {
        ends.push_back(part.end);
    }
    return {corners, ends};
}

TEST(TinVertices, KeepsChunksAndPartsInTheOrderOfTheTinAlone) {
    const scene::Scene scene = sample::duneScene(32);
    const double cell = scene.terrain.cellSize();
    std::mt19937 random(9);
    Tin tin(scene.terrain);
    std::vector<std::pair<Tin::Vertex, std::array<Tin::Vertex, 3>>> within;
    for (Tin::Slot slot = 0; slot < 1500; slot += 3) {
        const auto corners = tin.mesh().triangles[static_cast<std::size_t>(slot)].corner;
        within.emplace_back(tin.split(slot, 65536.0 * static_cast<double>(random() % 4)), corners);
    }
    (void)tin.takeParts();
    TinVertices surface(tin.view(), cell);
    for (int round = 0; round < 4; ++round) {
        // Weights of a place that is nearer to one corner than to the others.
        for (const auto& [vertex, corners] : within) {
            const auto near = static_cast<std::size_t>(random() % 3);
            sand::tin::LatticePoint sum{0, 0};
            for (std::size_t k = 0; k < 3; ++k) {
                const auto& place = tin.mesh().places[static_cast<std::size_t>(corners[k])];
                const int weight = k == near ? 8 : 1;
                sum = {sum.x + weight * place.x, sum.y + weight * place.y};
            }
            tin.move(vertex, {sum.x / 10, sum.y / 10});
        }
        (void)surface.update(tin.view(), tin.takeParts());
        TinVertices fresh(tin.view(), cell);
        for (std::size_t i = 0; i < surface.chunks().size(); ++i) {
            ASSERT_EQ(orderOf(surface, surface.chunks()[i]), orderOf(fresh, fresh.chunks()[i])) << "round " << round;
        }
    }
}

TEST(TinVertices, PartsTileAChunkAndHoldTheirTriangles) {
    const scene::Scene scene = sample::duneScene(64);
    const Tin tin(scene.terrain);
    TinVertices surface(tin.view(), scene.terrain.cellSize());
    std::size_t most = 0;
    for (TinChunk& chunk : surface.chunks()) {
        (void)surface.settle(chunk);
        std::size_t last = 0;
        for (const TinChunk::Part& part : surface.partsOf(chunk)) {
            EXPECT_EQ(part.first, last);
            EXPECT_GT(part.end, part.first);
            last = part.end;
        }
        EXPECT_EQ(last, chunk.slots.size());
        most = std::max(most, surface.partsOf(chunk).size());
    }
    EXPECT_GT(most, 1);
}

TEST(TinVertices, BesideAHoleOnlyWhatIsNearIsDrawnAnew) {
    const scene::Scene scene = sample::duneScene(64);
    const double cell = scene.terrain.cellSize();
    Tin tin(scene.terrain);
    const double middle = 32 * sand::kProbePerCell, half = 2 * sand::kProbePerCell;
    tin.cut([&](double x, double y) { return std::abs(x - middle) < half && std::abs(y - middle) < half; });
    (void)tin.takeParts();
    TinVertices surface(tin.view(), cell);
    const Tin::Vertex beside = 32 * 66 + 30;  // in rows of 66 vertices
    const auto place = tin.mesh().places[beside];
    tin.setHeight(beside, tin.height(beside) + 1e6);
    const TinVertices::Change change = surface.update(tin.view(), tin.takeParts());
    const glm::dvec2 at = glm::dvec2(place.x, place.y) * (cell / sand::kProbePerCell);
    const double reach = 14 * cell;  // reach of light, and a triangle's side
    EXPECT_FALSE(change.boxes.empty());
    for (const shapes::Box& box : change.boxes) {
        EXPECT_TRUE(glm::all(glm::greaterThan(glm::dvec2(box.low), at - reach))) << box.low.x << ", " << box.low.y;
        EXPECT_TRUE(glm::all(glm::lessThan(glm::dvec2(box.high), at + reach))) << box.high.x << ", " << box.high.y;
    }
}

TEST(TinVertices, AndTheirTrianglesAndCutsAreThoseOfAPage) {
    const scene::Scene scene = sample::duneScene(64);
    const double cell = scene.terrain.cellSize(), middle = 32 * sand::kProbePerCell, half = 2 * sand::kProbePerCell;
    Tin tin(scene.terrain);
    tin.cut([&](double x, double y) { return std::abs(x - middle) < half && std::abs(y - middle) < half; });
    (void)tin.takeParts();
    const sand::tin::SurfaceView view = tin.view();
    const TinVertices wall(view, cell);
    shapes::TinParts page(cell);
    ASSERT_TRUE(page.take(sand::TinData{view}).whole);
    const shapes::SurfacePart part = page.part(0);
    ASSERT_EQ(part.heights.size(), wall.vertices().size());
    std::size_t corners = 0;
    const std::vector<std::uint32_t> triangles = page.triangles(0);
    for (const shapes::TinTriangle& triangle : wall.triangles()) {
        for (std::size_t i = 0; i < 3 && triangle.alive(); ++i) {
            const auto number = static_cast<std::size_t>(triangle.corner.at(i));
            const shapes::TinVertex& vertex = wall.vertices()[number];
            ASSERT_EQ(triangles.at(corners++), number);
            ASSERT_EQ(part.heights[number], vertex.height);
            ASSERT_EQ(part.places[2 * number], static_cast<float>(vertex.x));
            ASSERT_EQ(part.normals[2 * number + 1], vertex.normalNorth);
            ASSERT_EQ(part.shades[2 * number], vertex.open);
            ASSERT_EQ(part.shades[2 * number + 1], vertex.mottling);
        }
    }
    EXPECT_EQ(corners, triangles.size());
    const auto sorted = [](const shapes::SandRim& rim) {
        std::vector<std::array<float, 6>> cuts;
        for (const std::vector<glm::vec3>& line : rim.cuts) {
            cuts.push_back({line[0].x, line[0].y, line[0].z, line[1].x, line[1].y, line[1].z});
        }
        std::ranges::sort(cuts);
        return cuts;
    };
    EXPECT_EQ(sorted(page.rim()), sorted(wall.rim()));
    EXPECT_TRUE(page.rim().hasHoles);
    EXPECT_EQ(page.lowest(), wall.heightsEver().lowest);
}

}  // namespace
