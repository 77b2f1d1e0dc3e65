// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sand/tin/geometry/triangles.hpp"

namespace shapes {

/// Index of a TIN's vertices by squares of the field, to find the vertices near a place. Not thread-safe.
class VertexSquares {
public:
    using LatticePoint = sand::tin::LatticePoint;
    using Vertex = sand::tin::Vertex;

    VertexSquares(std::int32_t width, std::int32_t depth /* of the field */, double side /* [probe unit], all */)
        : side_(side),
          columns_(numberOf(width) + 1),
          rows_(numberOf(depth) + 1),
          vertices_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

    void add(Vertex vertex, const LatticePoint& place) { around(place).push_back(vertex); }
    /// Removes a vertex that was added at `place`.
    void remove(Vertex vertex, const LatticePoint& place) {
        std::vector<Vertex>& there = around(place);
        *std::find(there.begin(), there.end(), vertex) = there.back();
        there.pop_back();
    }
    /// Calls visit(vertex) for all vertices in the squares that a rectangle touches: those within it, and some around
    /// it.
    template <class Visit>
    void visitNear(const LatticePoint& southWest, const LatticePoint& northEast, const Visit& visit) const {
        const int east = std::min(numberOf(northEast.x), columns_ - 1),
                  north = std::min(numberOf(northEast.y), rows_ - 1);
        for (int row = std::max(numberOf(southWest.y), 0); row <= north; ++row) {
            for (int column = std::max(numberOf(southWest.x), 0); column <= east; ++column) {
                std::for_each(vertices_[at(column, row)].begin(), vertices_[at(column, row)].end(), visit);
            }
        }
    }

private:
    [[nodiscard]] int numberOf(std::int32_t along) const { return static_cast<int>(along / side_); }
    [[nodiscard]] std::size_t at(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
    }
    [[nodiscard]] std::vector<Vertex>& around(const LatticePoint& place) {
        return vertices_[at(numberOf(place.x), numberOf(place.y))];
    }

    double side_;
    int columns_, rows_;
    std::vector<std::vector<Vertex>> vertices_;  // row by row from the south-west
};

}  // namespace shapes
