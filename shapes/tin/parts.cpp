// SPDX-License-Identifier: Apache-2.0
#include "shapes/tin/parts.hpp"

#include <algorithm>
#include <limits>

#include "shapes/tin/light.hpp"

namespace shapes {

using sand::tin::Vertex;

SurfaceParts::Change TinParts::take(const sand::SurfaceData& data) {
    const sand::tin::SurfaceView& tin = std::get<sand::TinData>(data).view;
    const sand::tin::Triangles& mesh = tin.triangles;
    width_ = mesh.width;
    depth_ = mesh.depth;
    geometry_ = {.cellSize = geometry_.cellSize};
    geometry_.grow(mesh);
    for (std::int32_t slot = 0; slot < static_cast<std::int32_t>(mesh.triangles.size()); ++slot) {
        geometry_.triangle(slot) = TinGeometry::drawnOf(mesh, slot);
        const sand::tin::Triangle& triangle = mesh.triangles[static_cast<std::size_t>(slot)];
        hasHoles_ |= triangle.alive() && triangle.hole;
    }
    std::vector<Vertex> all;
    for (Vertex number = 0; number < static_cast<Vertex>(mesh.triangleAt.size()); ++number) {
        if (mesh.alive(number)) {
            TinVertex& vertex = geometry_.vertex(number) = geometry_.placed(tin, number);
            vertex.mottling = TinLight::mottlingOf(vertex.x, vertex.y);
            all.push_back(number);
        }
    }
    TinLight(width_, depth_, std::max(width_, depth_)).lightAll(tin, geometry_, all);
    return {.parts = {0}, .whole = true, .rim = true};
}

SurfacePart TinParts::part(int) const {
    SurfacePart part;
    for (const TinVertex& vertex : geometry_.vertices) {
        part.add(vertex, static_cast<float>(vertex.x), static_cast<float>(vertex.y));
    }
    return part;
}

std::vector<std::uint32_t> TinParts::triangles(int) const {
    std::vector<std::uint32_t> all;
    for (const TinTriangle& triangle : geometry_.triangles) {
        if (triangle.alive()) {
            all.insert(all.end(), triangle.corner.begin(), triangle.corner.end());
        }
    }
    return all;
}

PlaceUniforms TinParts::places() const { return {static_cast<float>(geometry_.probe), glm::vec2(width_, depth_), 0}; }

SandRim TinParts::rim() const {
    SandRim rim{glm::vec2(width_ * geometry_.probe, depth_ * geometry_.probe), {}, hasHoles_};
    for (const TinTriangle& triangle : geometry_.triangles) {
        for (std::size_t corner = 0; corner < 3 && triangle.alive(); ++corner) {
            if (triangle.cut.at(corner)) {
                rim.cuts.push_back({glm::vec3(geometry_.at(triangle.corner.at((corner + 1) % 3))),
                                    glm::vec3(geometry_.at(triangle.corner.at((corner + 2) % 3)))});
            }
        }
    }
    return rim;
}

float TinParts::lowest() const {
    float lowest = std::numeric_limits<float>::max();
    for (const TinTriangle& triangle : geometry_.triangles) {
        for (const Vertex corner : triangle.corner) {
            lowest = triangle.alive() ? std::min(lowest, geometry_.vertex(corner).height) : lowest;
        }
    }
    return lowest;
}

}  // namespace shapes
