// SPDX-License-Identifier: Apache-2.0
#include "render_node/tin/vertices.hpp"

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
      changedBoxes_(width_ * geometry_.probe, depth_ * geometry_.probe) {
    const Triangles& mesh = tin.triangles;
    grow(mesh);
    std::vector<Vertex> all;
    for (Vertex number = 0; number < static_cast<Vertex>(mesh.triangleAt.size()); ++number) {
        if (mesh.alive(number)) {
            all.push_back(number);
        }
    }
    ever_.lowest = ever_.highest =
        static_cast<float>(tin.heights[static_cast<std::size_t>(all.front())] * geometry_.unit);
    (void)move(tin, all);
    elsewhere_ = std::vector<Vertex>();  // frees the room for all vertices
    for (std::size_t slot = 0; slot < mesh.triangles.size(); ++slot) {
        chunks_.replace(geometry_, static_cast<std::int32_t>(slot), TinGeometry::drawnOf(mesh.triangles[slot]));
    }
    light_.lightAll(tin, geometry_, all);
}

void TinVertices::grow(const Triangles& mesh) {
    geometry_.grow(mesh);
    chunks_.grow(geometry_.triangles.size());
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
    const auto drawn = [&](std::int32_t slot) {
        return TinGeometry::drawnOf(mesh.triangles[static_cast<std::size_t>(slot)]);
    };
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
    change.rim = move(tin, others);
    for (const std::int32_t slot : replaced) {
        chunks_.replace(geometry_, slot, drawn(slot));
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

std::optional<Box> TinVertices::reachOf(const SurfaceView& tin, const sand::TinChange& sandChange) {
    const TinBounds changed = geometry_.boundsOf(tin, sandChange);
    if (changed.west <= 0 || changed.south <= 0 || changed.east >= width_ || changed.north >= depth_) {
        return std::nullopt;
    }
    const double probe = geometry_.probe;
    const Box reach{{changed.west * probe, changed.south * probe, changed.lowest},
                    {changed.east * probe, changed.north * probe, changed.highest}};
    // Vertices within this distance see a changed sky, and the triangles around them are shaded again.
    const double margin = TinLight::kReach * geometry_.cellSize;
    return chunks_.withChunksAt(geometry_, {reach.low - margin, reach.high + margin});
}

/// Copies places and heights of `vertices`. Returns whether the rim has changed.
bool TinVertices::move(const SurfaceView& tin, std::span<const Vertex> vertices) {
    bool rim = false;
    for (const Vertex number : vertices) {
        rim |= keepRim(number, false);
    }
    elsewhere_.clear();
    for (const Vertex number : vertices) {
        TinVertex& drawn = geometry_.vertex(number);
        const TinVertex before = std::exchange(drawn, geometry_.placed(tin, number));
        if (before.x != drawn.x || before.y != drawn.y) {
            light_.move(number, before, drawn);
            if (drawn.x >= 0) {
                elsewhere_.push_back(number);
            }
        }
        if (drawn.x >= 0) {
            drawn.mottling = TinLight::mottlingOf(drawn.x, drawn.y);
            ever_ = around(ever_, {drawn.height, drawn.height});
            rim |= keepRim(number, true);
        }
    }
    return rim;
}

/// Adds a vertex to the rim, or removes it, if it lies on the rim. Returns whether it does.
bool TinVertices::keepRim(Vertex number, bool present) {
    const TinVertex& drawn = geometry_.vertex(number);
    if (drawn.x < 0) {
        return false;
    }
    bool onRim = false;
    const auto keep = [&](std::size_t side, bool there, std::int32_t along) {
        if (there && present) {
            rim_[side][along] = number;
        } else if (there) {
            rim_[side].erase(along);
        }
        onRim |= there;
    };
    keep(0, drawn.y == 0, drawn.x);
    keep(1, drawn.x == width_, drawn.y);
    keep(2, drawn.y == depth_, width_ - drawn.x);
    keep(3, drawn.x == 0, depth_ - drawn.y);
    return onRim;
}

SandRim TinVertices::rim() const {
    SandRim rim;
    for (std::size_t side = 0; side < rim_.size(); ++side) {
        for (const auto& [along, number] : rim_[side]) {
            rim.sides[side].emplace_back(geometry_.at(number));
        }
    }
    return rim;
}

}  // namespace render_node
