// SPDX-License-Identifier: Apache-2.0
#include "shapes/tin/geometry.hpp"

namespace shapes {
namespace {

using sand::tin::LatticePoint;
using sand::tin::SurfaceView;
using sand::tin::Triangle;

}  // namespace

void TinGeometry::grow(const sand::tin::Triangles& mesh) {
    vertices.resize(std::max(vertices.size(), mesh.places.size()));
    triangles.resize(std::max(triangles.size(), mesh.triangles.size()));
}

glm::dvec3 TinGeometry::at(Vertex number) const {
    const TinVertex& drawn = vertex(number);
    return {drawn.x * probe, drawn.y * probe, drawn.height};
}

Box TinGeometry::boxOf(const TinTriangle& triangle) const {
    const glm::dvec3 a = at(triangle.corner[0]), b = at(triangle.corner[1]), c = at(triangle.corner[2]);
    const double margin = 0.01 * cellSize;
    return {glm::min(a, glm::min(b, c)) - margin, glm::max(a, glm::max(b, c)) + margin};
}

TinTriangle TinGeometry::drawnOf(const sand::tin::Triangles& mesh, std::int32_t slot) {
    const Triangle& triangle = mesh.triangles[static_cast<std::size_t>(slot)];
    TinTriangle drawn;
    if (!triangle.isGround()) {
        return drawn;
    }
    const auto least = std::min_element(triangle.corner.begin(), triangle.corner.end()) - triangle.corner.begin();
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t from = (static_cast<std::size_t>(least) + i) % 3;
        drawn.corner[i] = triangle.corner[from];
        const std::int32_t beyond = triangle.neighbour[from];
        drawn.marked[i] = triangle.constrained[from] && beyond != sand::tin::kNoNumber;
        drawn.cut[i] = beyond == sand::tin::kNoNumber || mesh.triangles[static_cast<std::size_t>(beyond)].hole;
    }
    return drawn;
}

TinVertex TinGeometry::placed(const SurfaceView& tin, Vertex number) const {
    const bool known = static_cast<std::size_t>(number) < vertices.size();
    TinVertex now = known ? vertex(number) : TinVertex{};
    if (!tin.triangles.alive(number)) {
        now.x = now.y = -1;
        return now;
    }
    const LatticePoint& place = tin.triangles.places[static_cast<std::size_t>(number)];
    now.x = place.x;
    now.y = place.y;
    now.height = static_cast<float>(tin.heights[static_cast<std::size_t>(number)] * unit);
    return now;
}

std::vector<sand::tin::Vertex> TinGeometry::moved(const SurfaceView& tin, std::span<const Vertex> asked) const {
    std::vector<Vertex> others;
    for (const Vertex number : asked) {
        if (static_cast<std::size_t>(number) >= vertices.size()) {
            continue;  // the vertex was added and removed between two updates
        }
        const TinVertex& drawn = vertex(number);
        const TinVertex now = placed(tin, number);
        if (drawn.x != now.x || drawn.y != now.y || drawn.height != now.height) {
            others.push_back(number);
        }
    }
    return others;
}

TinBounds TinGeometry::boundsOf(const SurfaceView& tin, const sand::TinChange& sandChange) const {
    const sand::tin::Triangles& mesh = tin.triangles;
    TinBounds changed;
    const auto addVertex = [&](Vertex corner) {
        const auto number = static_cast<std::size_t>(corner);
        changed.add(mesh.places[number].x, mesh.places[number].y, tin.heights[number] * unit);
    };
    const auto addDrawn = [&](Vertex number) {
        const bool known = static_cast<std::size_t>(number) < vertices.size();
        if (known && vertex(number).x >= 0) {
            changed.add(vertex(number).x, vertex(number).y, vertex(number).height);
        }
    };
    for (const std::int32_t slot : sandChange.triangles) {
        const Triangle& now = mesh.triangles[static_cast<std::size_t>(slot)];
        if (now.isGround()) {
            std::for_each(now.corner.begin(), now.corner.end(), addVertex);
        }
        if (static_cast<std::size_t>(slot) < triangles.size() && triangle(slot).alive()) {
            std::for_each(triangle(slot).corner.begin(), triangle(slot).corner.end(), addDrawn);
        }
    }
    // The drawn triangles in a star's slots need no box here. They either belong to that star, or have changed earlier,
    // and the box of that change contains them.
    for (const Vertex number : sandChange.vertices) {
        addDrawn(number);
        if (mesh.alive(number)) {
            addVertex(number);
            aroundVertex(mesh, number, [&](std::int32_t slot, int corner) {
                const Triangle& now = mesh.triangles[static_cast<std::size_t>(slot)];
                for (std::size_t k = 1; k < 3 && !now.hole; ++k) {
                    addVertex(now.corner[(static_cast<std::size_t>(corner) + k) % 3]);
                }
            });
        }
    }
    return changed;
}

}  // namespace shapes
