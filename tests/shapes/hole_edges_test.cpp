// SPDX-License-Identifier: Apache-2.0
#include "shapes/grid/hole_edges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <map>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/support/seed.hpp"

namespace {

using shapes::GridVertex;

using CornerPlace = std::tuple<int, int, float>;  // column, row [half a cell], height

/// Returns the length of an edge of triangles on the ground [cell], without the half cell that is folded at the
/// field's edge.
double lengthOf(const CornerPlace& from, const CornerPlace& to, int columns, int rows) {
    const auto along = [](int place, int cells) { return std::clamp(0.5 * (place - 1), 0.0, double(cells)); };
    return std::hypot(along(std::get<0>(from), columns) - along(std::get<0>(to), columns),
                      along(std::get<1>(from), rows) - along(std::get<1>(to), rows));
}

// Edges of triangles are in pairs, except along the outline. So the surface has no crack, and ends at the edges of
// cells.
TEST(HoleEdges, CutTheSurfaceAlongTheEdgesOfCellsWithoutACrack) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    for (int round = 0; round < 50; ++round) {
        const int columns = 3 + static_cast<int>(random() % 9), rows = 3 + static_cast<int>(random() % 7);
        sand::HeightField field(columns, rows, 1);
        sand::Ground ground(columns, rows);
        double area = 0, outline = 0;
        for (int row = 0; row < rows; ++row) {
            for (int column = 0; column < columns; ++column) {
                field.setHeight(column, row, static_cast<std::int32_t>(random() % 200000));
                if (random() % 3 == 0) {
                    ground.setWall(column, row);
                }
            }
        }
        const auto has = [&](int column, int row) {
            return column >= 0 && row >= 0 && column < columns && row < rows && !ground.isWall(column, row);
        };
        for (int row = 0; row < rows; ++row) {
            for (int column = 0; column < columns; ++column) {
                area += has(column, row) ? 1 : 0;
                for (const glm::ivec2 side : {glm::ivec2(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
                    outline += has(column, row) && !has(column + side.x, row + side.y) ? 1 : 0;
                }
            }
        }
        const shapes::GridVertices surface(field, &ground);
        const sand::CellRect all{0, 0, columns + 2, rows + 2};
        std::vector<GridVertex> vertices = surface.verticesIn(all);
        const shapes::HoleEdges holes(surface, all);
        const std::vector<GridVertex> added = holes.added(vertices);
        vertices.insert(vertices.end(), added.begin(), added.end());
        std::map<std::pair<CornerPlace, CornerPlace>, int> edges;
        double covered = 0, cut = 0;
        for (std::size_t i = 0; i < holes.indices().size(); i += 3) {
            std::array<CornerPlace, 3> corners;
            for (std::size_t j = 0; j < 3; ++j) {
                const GridVertex& vertex = vertices[holes.indices()[i + j]];
                corners[j] = {vertex.column, vertex.row, vertex.height};
            }
            const auto at = [&](std::size_t j) {
                return glm::dvec2(std::clamp(0.5 * (std::get<0>(corners[j]) - 1), 0.0, double(columns)),
                                  std::clamp(0.5 * (std::get<1>(corners[j]) - 1), 0.0, double(rows)));
            };
            const glm::dvec2 a = at(1) - at(0), b = at(2) - at(0);
            EXPECT_GE(a.x * b.y - a.y * b.x, 0) << "clockwise";
            covered += 0.5 * (a.x * b.y - a.y * b.x);
            for (std::size_t j = 0; j < 3; ++j) {
                ++edges[{corners[j], corners[(j + 1) % 3]}];
            }
        }
        for (const auto& [edge, count] : edges) {
            const auto back = edges.find({edge.second, edge.first});
            if (back == edges.end()) {
                cut += lengthOf(edge.first, edge.second, columns, rows);
            }
        }
        EXPECT_DOUBLE_EQ(covered, area) << "round " << round;
        EXPECT_NEAR(cut, outline, 1e-9) << "round " << round;
        double sides = 0;
        for (const auto& line : surface.rim().cuts) {
            for (std::size_t i = 1; i < line.size(); ++i) {
                sides += double{glm::distance(glm::vec2(line[i - 1]), glm::vec2(line[i]))};
            }
        }
        EXPECT_NEAR(sides, outline, 1e-4) << "the cut sides of the sand";
    }
}

}  // namespace
