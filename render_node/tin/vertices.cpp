// SPDX-License-Identifier: Apache-2.0
#include "render_node/tin/vertices.hpp"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

namespace render_node {
namespace {

using sand::tin::SurfaceView;
using sand::tin::Triangles;
using sand::tin::Vertex;

}  // namespace

TinVertices::TinVertices(const SurfaceView& tin, double cellSize, double chunkSide)
    : width_(tin.triangles.width),
      depth_(tin.triangles.depth),
      geometry_{.cellSize = cellSize},
      chunks_(width_, depth_, chunkSide),
      light_(width_, depth_, chunkSide),
      changedBoxes_(width_ * geometry_.probe, depth_ * geometry_.probe),
      hasHoles_(std::ranges::any_of(tin.triangles.triangles, [](const auto& one) { return one.alive() && one.hole; })) {
    const Triangles& mesh = tin.triangles;
    grow(mesh);
    std::vector<Vertex> all;
    for (Vertex number = 0; number < static_cast<Vertex>(mesh.triangleAt.size()); ++number) {
        if (mesh.alive(number)) {
            all.push_back(number);
        }
    }
    ever_ = {std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()};
    (void)move(tin, all);
    elsewhere_ = std::vector<Vertex>();  // frees the room for all vertices
    for (std::size_t slot = 0; slot < mesh.triangles.size(); ++slot) {
        const auto number = static_cast<std::int32_t>(slot);
        chunks_.replace(geometry_, number, shapes::TinGeometry::drawnOf(mesh, number));
        keepCuts(number, true);
    }
    light_.lightAll(tin, geometry_, all);
}

void TinVertices::grow(const Triangles& mesh) {
    geometry_.grow(mesh);
    chunks_.grow(geometry_.triangles.size());
    cutsAt_.resize(geometry_.vertices.size());
}

TinVertices::Change TinVertices::replaceWhole(const SurfaceView& tin) {
    TinVertices anew(tin, geometry_.cellSize, chunks_.side());
    anew.ever_ = around(ever_, anew.ever_);
    *this = std::move(anew);
    Change change;
    change.whole = change.rim = true;
    const double cell = geometry_.cellSize, probe = geometry_.probe;
    change.boxes.push_back(
        {glm::dvec3(-cell, -cell, ever_.lowest - cell),
         glm::dvec3((width_ + kCell) * probe, (depth_ + kCell) * probe, double{ever_.highest} + cell)});
    return change;
}

TinVertices::Change TinVertices::update(const SurfaceView& tin, const sand::TinChange& sandChange) {
    Change change;
    const Triangles& mesh = tin.triangles;
    grow(mesh);
    const auto drawn = [&](std::int32_t slot) { return shapes::TinGeometry::drawnOf(mesh, slot); };
    std::vector<std::int32_t> replaced;
    for (const std::int32_t slot : sandChange.triangles) {
        if (geometry_.triangle(slot) != drawn(slot)) {
            replaced.push_back(slot);
        }
    }
    std::vector<Vertex> others = geometry_.moved(tin, sandChange.vertices);
    reshaped_.clear();
    reshaped_.add(replaced);
    for (const Vertex number : others) {
        if (mesh.alive(number)) {
            aroundVertex(mesh, number, [this](std::int32_t slot, int) { reshaped_.add(slot); });
        }
    }
    addBoxes(reshaped_.all());
    for (const std::int32_t slot : replaced) {
        change.rim |= keepCuts(slot, false);
    }
    change.rim |= move(tin, others);
    for (const std::int32_t slot : replaced) {
        chunks_.replace(geometry_, slot, drawn(slot));
        change.rim |= keepCuts(slot, true);
    }
    for (const Vertex number : elsewhere_) {
        aroundVertex(mesh, number, [this](std::int32_t slot, int) {
            if (geometry_.triangle(slot).alive()) {
                chunks_.keepHome(geometry_, slot);
            }
        });
    }
    addBoxes(reshaped_.all());
    const std::vector<Vertex> lit = relight(tin);
    others.insert(others.end(), lit.begin(), lit.end());
    sortOnce(others);
    change.vertices = std::move(others);
    change.boxes = changedBoxes_.take();
    return change;
}

/// Lights the surface after a change of the triangles in reshaped_. Returns the vertices whose light has changed. Adds
/// the triangles around them to the changes.
std::vector<Vertex> TinVertices::relight(const SurfaceView& tin) {
    for (const std::int32_t slot : reshaped_.all()) {
        if (geometry_.triangle(slot).alive()) {
            chunks_.reshape(slot);
        }
    }
    std::vector<Vertex> lit = light_.relight(tin, geometry_, reshaped_.all());
    shaded_.clear();
    for (const Vertex number : lit) {
        aroundVertex(tin.triangles, number, [this](std::int32_t slot, int) { shaded_.add(slot); });
    }
    addBoxes(shaded_.all());
    return lit;
}

/// Adds boxes around triangles to the changes. Triangles in holes are not drawn.
void TinVertices::addBoxes(const std::vector<std::int32_t>& slots) {
    for (const std::int32_t slot : slots) {
        if (geometry_.triangle(slot).alive()) {
            changedBoxes_.add(geometry_.boxOf(geometry_.triangle(slot)));
        }
    }
}

std::optional<shapes::Box> TinVertices::reachOf(const SurfaceView& tin, const sand::TinChange& sandChange) {
    const shapes::TinBounds changed = geometry_.boundsOf(tin, sandChange);
    if (hasHoles_ || changed.west <= 0 || changed.south <= 0 || changed.east >= width_ || changed.north >= depth_) {
        return std::nullopt;
    }
    const double probe = geometry_.probe;
    const shapes::Box reach{{changed.west * probe, changed.south * probe, changed.lowest},
                            {changed.east * probe, changed.north * probe, changed.highest}};
    // Vertices within this distance see a changed sky, and the triangles around them are shaded again.
    const double margin = shapes::TinLight::kReach * geometry_.cellSize;
    return chunks_.withChunksAt(geometry_, {reach.low - margin, reach.high + margin});
}

/// Copies places and heights of `vertices`. Returns whether one of them is on a cut edge.
bool TinVertices::move(const SurfaceView& tin, std::span<const Vertex> vertices) {
    bool rim = false;
    elsewhere_.clear();
    for (const Vertex number : vertices) {
        shapes::TinVertex& drawn = geometry_.vertex(number);
        const shapes::TinVertex before = std::exchange(drawn, geometry_.placed(tin, number));
        if (before.x != drawn.x || before.y != drawn.y) {
            light_.move(number, before, drawn);
            if (drawn.x >= 0) {
                elsewhere_.push_back(number);
            }
        }
        if (drawn.x >= 0) {
            drawn.mottling = shapes::TinLight::mottlingOf(drawn.x, drawn.y);
            widen(tin, number);
            rim |= cutsAt_[static_cast<std::size_t>(number)] > 0;
        }
    }
    return rim;
}

/// Takes the height of a vertex into the range of all heights, unless the vertex lies in a hole.
void TinVertices::widen(const SurfaceView& tin, Vertex number) {
    bool ground = !hasHoles_;
    if (!ground) {
        aroundVertex(tin.triangles, number, [&](std::int32_t slot, int) {
            ground |= !tin.triangles.triangles[static_cast<std::size_t>(slot)].hole;
        });
    }
    if (ground) {
        const float height = geometry_.vertex(number).height;
        ever_ = around(ever_, {height, height});
    }
}

bool TinVertices::keepCuts(std::int32_t slot, bool present) {
    constexpr std::int32_t kSquare = 32 * kCell;  // [probe unit]
    const shapes::TinTriangle& triangle = geometry_.triangle(slot);
    bool any = false;
    for (std::size_t corner = 0; corner < 3 && triangle.alive(); ++corner) {
        if (!triangle.cut.at(corner)) {
            continue;
        }
        any = true;
        const Vertex from = triangle.corner.at((corner + 1) % 3), to = triangle.corner.at((corner + 2) % 3);
        const shapes::TinVertex& begin = geometry_.vertex(from);
        for (const Vertex end : {from, to}) {
            cutsAt_[static_cast<std::size_t>(end)] += present ? 1 : -1;
        }
        if (present) {
            cuts_[{slot, corner}] = begin.y / kSquare * (width_ / kSquare + 1) + begin.x / kSquare;
        } else {
            cuts_.erase({slot, corner});
        }
    }
    return any;
}

shapes::SandRim TinVertices::rim() const {
    shapes::SandRim rim{glm::vec2(width_ * geometry_.probe, depth_ * geometry_.probe), {}, hasHoles_};
    std::vector<std::tuple<std::int32_t, std::int32_t, std::size_t>> cuts;  // square, slot, corner
    for (const auto& [edge, square] : cuts_) {
        cuts.emplace_back(square, edge.first, edge.second);
    }
    std::ranges::sort(cuts);  // so that neighbouring edges follow each other
    for (const auto& [square, slot, corner] : cuts) {
        const shapes::TinTriangle& triangle = geometry_.triangle(slot);
        rim.cuts.push_back({glm::vec3(geometry_.at(triangle.corner.at((corner + 1) % 3))),
                            glm::vec3(geometry_.at(triangle.corner.at((corner + 2) % 3)))});
    }
    return rim;
}

}  // namespace render_node
