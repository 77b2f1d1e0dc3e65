// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "sand/model/surface_data.hpp"
#include "shapes/model/sand_rim.hpp"

namespace shapes {

/// Values of the uniforms by which sand.vert.glsl turns aGrid into a place.
struct PlaceUniforms {
    float cell;       // uCell: unit of aGrid [scene unit]
    glm::vec2 cells;  // uCells: sides of the field
    float first;      // uFirst: value at the field's edge
};

/// Neighbouring vertices of the sand, with an array for each input of sand.vert.glsl.
struct SurfacePart {
    std::uint32_t first = 0;            // number of the first vertex
    std::vector<float> heights;         // aHeight
    std::vector<float> places;          // aGrid, two for each vertex
    std::vector<std::int16_t> normals;  // aNormal, two for each vertex
    std::vector<std::uint16_t> shades;  // aShade, two for each vertex

    /// Adds a GridVertex or a TinVertex at its place.
    template <class Vertex>
    void add(const Vertex& vertex, float x, float y) {
        heights.push_back(vertex.height);
        places.insert(places.end(), {x, y});
        normals.insert(normals.end(), {vertex.normalEast, vertex.normalNorth});
        shades.insert(shades.end(), {vertex.open, vertex.mottling});
    }
};

/// The surface of the sand in parts, at level 0, for a drawing that has all vertices in one buffer.
///
/// Vertices and triangles are those of the wall. Not thread-safe.
class SurfaceParts {
public:
    SurfaceParts() = default;
    SurfaceParts(const SurfaceParts&) = delete;
    SurfaceParts& operator=(const SurfaceParts&) = delete;
    virtual ~SurfaceParts() = default;

    /// Parts that differ from those at the last call of take().
    struct Change {
        std::vector<int> parts;
        bool whole = false;  // every vertex has another number, and there are other triangles
        bool rim = false;    // rim() differs
    };
    /// Takes the present sand. The sand must have the kind and size for which this object was made.
    [[nodiscard]] virtual Change take(const sand::SurfaceData& data) = 0;
    /// Returns the number of all vertices.
    [[nodiscard]] virtual std::size_t vertices() const = 0;
    [[nodiscard]] virtual SurfacePart part(int number) const = 0;
    /// Returns the triangles of a part as numbers of vertices, counter-clockwise from above.
    [[nodiscard]] virtual std::vector<std::uint32_t> triangles(int part) const = 0;
    [[nodiscard]] virtual PlaceUniforms places() const = 0;
    [[nodiscard]] virtual SandRim rim() const = 0;
    /// Returns the lowest height of the sand [scene unit].
    [[nodiscard]] virtual float lowest() const = 0;
};

}  // namespace shapes
