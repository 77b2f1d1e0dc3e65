// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/index_set.hpp"
#include "sand/model/cell_array.hpp"
#include "sand/tin/geometry/surface_view.hpp"
#include "shapes/model/open_sky.hpp"
#include "shapes/tin/geometry.hpp"
#include "shapes/tin/relief.hpp"
#include "shapes/tin/vertex_squares.hpp"

namespace shapes {

/// Computes the light on a TIN: normals, mottling, and the visible share of the sky at its vertices.
///
/// All functions expect the same geometry. Not thread-safe.
class TinLight {
public:
    using Vertex = sand::tin::Vertex;

    /// Largest distance at which a place reads heights: the largest sky distance, and two cells for interpolation
    /// [cell].
    static constexpr int kReach = kSkyDistances.back() + 2;

    /// `side` is that of the squares by which it finds the vertices near a place.
    TinLight(std::int32_t width, std::int32_t depth /* of the field */, double side /* [probe unit], all */)
        : squares_(width, depth, side), relief_(width, depth) {}

    /// Returns the mottling of a grid of the same cells, linear between the cells' middles [1/65535]. The place is in
    /// probe units.
    [[nodiscard]] static std::uint16_t mottlingOf(std::int32_t x, std::int32_t y);

    /// Says that a vertex has moved, is new, or is removed: `now` is not where `before` was.
    void move(Vertex number, const TinVertex& before, const TinVertex& now);
    /// Lights `all`, which are all vertices of a new surface, with all its triangles.
    void lightAll(const sand::tin::SurfaceView& tin, TinGeometry& geometry, std::span<const Vertex> all);
    /// Lights the vertices that see a change of the triangles in these slots. Returns those whose light has changed.
    [[nodiscard]] std::vector<Vertex> relight(const sand::tin::SurfaceView& tin, TinGeometry& geometry,
                                              std::span<const std::int32_t> reshaped);

private:
    void addToRelief(const sand::tin::SurfaceView& tin, const TinTriangle& triangle);
    bool openTo(const sand::tin::SurfaceView& tin, Vertex number, TinVertex& drawn) const;
    void addVerticesAround(const TinGeometry& geometry, const std::vector<sand::CellRect>& cells);

    VertexSquares squares_;
    TinRelief relief_;
    base::IndexList lit_;  // scratch: vertices
};

}  // namespace shapes
