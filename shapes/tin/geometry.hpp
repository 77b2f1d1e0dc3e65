// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "sand/model/surface_data.hpp"
#include "sand/model/units.hpp"
#include "sand/tin/geometry/surface_view.hpp"
#include "shapes/model/box.hpp"

namespace shapes {

/// Vertex of a TIN, as the shader reads it.
struct TinVertex {
    float height = 0;                              // [scene unit]
    std::int32_t x = -1, y = -1;                   // [probe unit]; −1 if no vertex has this number
    std::int16_t normalEast = 0, normalNorth = 0;  // 1/32767, mean normal of the triangles around it, weighted by area
    std::uint16_t open = 0;                        // visible share of the sky, 1/65535, in 255 steps
    std::uint16_t mottling = 0;                    // slow change of shade from place to place, 1/65535
};
static_assert(sizeof(TinVertex) == 20);

/// Triangle of a TIN, as it is drawn. Its corners are counter-clockwise and begin with the smallest number. So all
/// replicas compute it alike, although their meshes may have other slots and begin with other corners.
struct TinTriangle {
    std::array<sand::tin::Vertex, 3> corner{sand::tin::kNoNumber, sand::tin::kNoNumber, sand::tin::kNoNumber};
    std::array<bool, 3> marked{};  // whether the edge opposite the corner is a constraint inside the field
    std::array<bool, 3> cut{};     // whether no ground is beyond the edge opposite the corner
    [[nodiscard]] bool alive() const { return corner[0] != sand::tin::kNoNumber; }
    friend bool operator==(const TinTriangle&, const TinTriangle&) = default;
};

/// Bounds of places [probe unit] and heights [scene unit].
struct TinBounds {
    std::int32_t west = std::numeric_limits<std::int32_t>::max(), south = west;
    std::int32_t east = std::numeric_limits<std::int32_t>::min(), north = east;
    double lowest = std::numeric_limits<double>::max(), highest = std::numeric_limits<double>::lowest();

    void add(std::int32_t x, std::int32_t y, double height) {
        west = std::min(west, x);
        east = std::max(east, x);
        south = std::min(south, y);
        north = std::max(north, y);
        lowest = std::min(lowest, height);
        highest = std::max(highest, height);
    }
};

/// Vertices and triangles of a TIN as they are drawn. They do not follow the sand by themselves: TinVertices copies its
/// changes. Not thread-safe.
struct TinGeometry {
    using Vertex = sand::tin::Vertex;

    double cellSize = 0;                                   // [scene unit]
    double unit = cellSize / sand::kUnitsPerCell;          // unit of heights of the sand [scene unit]
    double probe = cellSize / sand::tin::kLatticePerCell;  // probe unit [scene unit]
    std::vector<TinVertex> vertices{};                     // by number
    std::vector<TinTriangle> triangles{};                  // by slot

    [[nodiscard]] TinVertex& vertex(Vertex number) { return vertices[static_cast<std::size_t>(number)]; }
    [[nodiscard]] const TinVertex& vertex(Vertex number) const { return vertices[static_cast<std::size_t>(number)]; }
    [[nodiscard]] TinTriangle& triangle(std::int32_t slot) { return triangles[static_cast<std::size_t>(slot)]; }
    [[nodiscard]] const TinTriangle& triangle(std::int32_t slot) const {
        return triangles[static_cast<std::size_t>(slot)];
    }

    /// Makes room for all numbers and slots of a mesh.
    void grow(const sand::tin::Triangles& mesh);
    /// Returns the place of a vertex [scene unit].
    [[nodiscard]] glm::dvec3 at(Vertex number) const;
    /// Returns the box around a triangle [scene unit], with a margin for rounding of GL's floats.
    [[nodiscard]] Box boxOf(const TinTriangle& triangle) const;

    /// Returns a triangle of the sand as it is drawn. A triangle that is not ground is not alive.
    [[nodiscard]] static TinTriangle drawnOf(const sand::tin::Triangles& mesh, std::int32_t slot);
    /// Returns a vertex at its place in the sand, with the light that it has here.
    [[nodiscard]] TinVertex placed(const sand::tin::SurfaceView& tin, Vertex number) const;
    /// Returns the vertices among `asked` that are new, removed, or at another place than drawn.
    [[nodiscard]] std::vector<Vertex> moved(const sand::tin::SurfaceView& tin, std::span<const Vertex> asked) const;
    /// Returns the bounds of everything that a change of the sand replaces or moves, before and after.
    [[nodiscard]] TinBounds boundsOf(const sand::tin::SurfaceView& tin, const sand::TinChange& sandChange) const;
};

}  // namespace shapes
