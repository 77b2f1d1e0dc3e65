// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <random>

#include "render_node/gl/grain_texture.hpp"
#include "render_node/grid/levels.hpp"
#include "render_node/tool/mesh.hpp"

namespace {

using render_node::kGrainSide;
using render_node::SandSurface;
using render_node::SandVertex;
using VertexBits = std::array<std::uint32_t, 4>;

std::vector<SandVertex> allVertices(const SandSurface& surface) {
    const sand::CellRect whole{0, 0, surface.columns() + 2, surface.rows() + 2};
    return render_node::verticesOf(surface, whole, 0);
}

TEST(SandSurface, NormalOfAnInclinedPlaneIsThatOfThePlane) {
    sand::HeightField field(9, 7, 0.5);
    for (int row = 0; row < 7; ++row) {
        for (int column = 0; column < 9; ++column) {
            field.setHeight(column, row, column * sand::kUnitsPerCell / 2 - row * sand::kUnitsPerCell / 4);
        }
    }
    const double length = std::sqrt(1 + 0.5 * 0.5 + 0.25 * 0.25);
    for (const SandVertex& vertex : allVertices(SandSurface(field))) {
        EXPECT_NEAR(vertex.normalEast / 32767.0, -0.5 / length, 1e-4);
        EXPECT_NEAR(vertex.normalNorth / 32767.0, 0.25 / length, 1e-4);
    }
}

TEST(SandSurface, LevelGroundSeesTheWholeSkyAndAPitLess) {
    sand::HeightField field(31, 31, 1);
    const std::vector<SandVertex> level = allVertices(SandSurface(field));
    EXPECT_TRUE(std::all_of(level.begin(), level.end(), [](const SandVertex& v) { return v.open == 65535; }));
    field.setHeight(15, 15, -4 * sand::kUnitsPerCell);
    // Each of the eight horizons is 4 cells up at 2 cells (2·√2 on the diagonals): sin² = 4/5 and 2/3.
    EXPECT_NEAR(allVertices(SandSurface(field))[16 * 33 + 16].open / 65535.0, 1 - (4 * 0.8 + 4 * 2.0 / 3) / 8, 1e-4);
}

TEST(SandSurface, EdgesOfTheFieldAreCoveredToTheirEnds) {
    const SandSurface surface{sand::HeightField(3, 1, 2)};
    EXPECT_FLOAT_EQ(surface.east(0), 0);
    EXPECT_FLOAT_EQ(surface.east(1), 1);
    EXPECT_FLOAT_EQ(surface.east(4), 6);
    EXPECT_FLOAT_EQ(surface.north(1), 1);
    EXPECT_FLOAT_EQ(surface.north(2), 2);
}

TEST(SandSurface, ACellChangesNoVertexBeyondItsReach) {
    std::mt19937 random(20240611);
    sand::HeightField field(40, 40, 1);
    for (int round = 0; round < 50; ++round) {
        const int x = static_cast<int>(random() % 40U);
        const int y = static_cast<int>(random() % 40U);
        const std::vector<SandVertex> before = allVertices(SandSurface(field));
        field.setHeight(x, y, field.height(x, y) + static_cast<int>(random() % 100000U) - 50000);
        const std::vector<SandVertex> after = allVertices(SandSurface(field));
        for (std::size_t i = 0; i < after.size(); ++i) {
            const int column = static_cast<int>(i % 42) - 1;
            const int row = static_cast<int>(i / 42) - 1;
            if (std::max(std::abs(column - x), std::abs(row - y)) > SandSurface::kReach + 1) {
                ASSERT_EQ(std::bit_cast<VertexBits>(before[i]), std::bit_cast<VertexBits>(after[i]))
                    << "seed 20240611, round " << round << ": cell " << x << "," << y << " changed vertex " << i;
            }
        }
    }
}

TEST(Grain, IsAsBrightOnAverageAsSmoothSand) {
    const std::vector<std::uint8_t> texels = render_node::makeGrain({0.7F, 0.7F});
    for (const std::size_t channel : {0U, 1U}) {
        double sum = 0;
        for (std::size_t i = channel; i < texels.size(); i += 4) {
            sum += texels[i];
        }
        EXPECT_NEAR(sum / (kGrainSide * kGrainSide), 127.5, 2) << "channel " << channel;
    }
}

TEST(Sphere, HasTheAreaOfASphereAndFacesOutward) {
    const auto triangles = render_node::makeSphere(3);
    ASSERT_EQ(triangles.size(), 3U * 20 * 64);
    double area = 0;
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        const glm::dvec3 a = triangles[i].position;
        const glm::dvec3 b = triangles[i + 1].position;
        const glm::dvec3 c = triangles[i + 2].position;
        const glm::dvec3 twice = glm::cross(b - a, c - a);
        area += glm::length(twice) / 2;
        EXPECT_GT(glm::dot(twice, a + b + c), 0);
    }
    EXPECT_NEAR(area, 4 * 3.14159265, 0.1);
}

}  // namespace
