// SPDX-License-Identifier: Apache-2.0
#include "render_node/tin/vertices.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sand/model/height_field.hpp"

namespace render_node {
namespace {

using sand::tin::kNoNumber;
using sand::tin::LatticePoint;
using sand::tin::SurfaceView;
using sand::tin::Triangles;
using sand::tin::Vertex;

constexpr double kTrianglesPerChunk = 512;
constexpr double kFewestChunksAcross = 32, kMostChunksAcross = 64;  // a coarse TIN becomes fine where sand is dug

}  // namespace

TinTriangle TinVertices::drawnOf(const sand::tin::Triangle& triangle) {
    TinTriangle drawn;
    if (!triangle.isGround()) {
        return drawn;
    }
    const auto least = std::min_element(triangle.corner.begin(), triangle.corner.end()) - triangle.corner.begin();
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t from = (static_cast<std::size_t>(least) + i) % 3;
        drawn.corner[i] = triangle.corner[from];
        drawn.marked[i] = triangle.constrained[from] && triangle.neighbour[from] != kNoNumber;
    }
    return drawn;
}

double TinVertices::chunkSideFor(const Triangles& mesh) {
    const double wanted = std::ceil(std::sqrt(static_cast<double>(mesh.triangles.size()) / kTrianglesPerChunk));
    return std::max(mesh.width, mesh.depth) / std::clamp(wanted, kFewestChunksAcross, kMostChunksAcross);
}

TinVertices::TinVertices(const SurfaceView& tin, double cellSize, double chunkSide)
    : cellSize_(cellSize),
      unit_(cellSize / sand::kUnitsPerCell),
      probe_(cellSize / kCell),
      width_(tin.triangles.width),
      depth_(tin.triangles.depth),
      across_(static_cast<int>(width_ / chunkSide) + 1),
      chunkSide_(chunkSide),
      chunks_(static_cast<std::size_t>(across_) * static_cast<std::size_t>(depth_ / chunkSide + 1)),
      squares_(width_, depth_, chunkSide),
      relief_(width_, depth_),
      changedBoxes_(width_ * probe_, depth_ * probe_) {
    const Triangles& mesh = tin.triangles;
    grow(mesh);
    std::vector<Vertex> all;
    for (Vertex number = 0; number < static_cast<Vertex>(mesh.triangleAt.size()); ++number) {
        if (mesh.alive(number)) {
            all.push_back(number);
        }
    }
    ever_.lowest = ever_.highest = static_cast<float>(tin.heights[static_cast<std::size_t>(all.front())] * unit_);
    (void)move(tin, all);
    elsewhere_ = std::vector<Vertex>();  // frees the room for all vertices
    for (std::size_t slot = 0; slot < mesh.triangles.size(); ++slot) {
        replace(static_cast<std::int32_t>(slot), drawnOf(mesh.triangles[slot]));
        addToRelief(tin, triangles_[slot]);
    }
    (void)relief_.takeChanged();
    for (const Vertex number : all) {
        lightFrom(tin, number);
        openTo(tin, number);
    }
}

void TinVertices::grow(const Triangles& mesh) {
    vertices_.resize(std::max(vertices_.size(), mesh.places.size()));
    triangles_.resize(std::max(triangles_.size(), mesh.triangles.size()));
    inChunk_.resize(triangles_.size());
}

TinVertices::Change TinVertices::replaceWhole(const SurfaceView& tin) {
    TinVertices anew(tin, cellSize_, chunkSide_);
    anew.ever_ = around(ever_, anew.ever_);
    *this = std::move(anew);
    Change change;
    change.whole = change.rim = true;
    change.boxes.push_back(
        {glm::dvec3(-cellSize_, -cellSize_, ever_.lowest - cellSize_),
         glm::dvec3((width_ + kCell) * probe_, (depth_ + kCell) * probe_, double{ever_.highest} + cellSize_)});
    return change;
}

TinVertices::Change TinVertices::update(const SurfaceView& tin, const sand::TinChange& sandChange) {
    Change change;
    const Triangles& mesh = tin.triangles;
    grow(mesh);
    std::vector<std::int32_t> replaced;
    for (const std::int32_t slot : sandChange.triangles) {
        if (triangle(slot) != drawnOf(mesh.triangles[static_cast<std::size_t>(slot)])) {
            replaced.push_back(slot);
        }
    }
    std::vector<Vertex> others = moved(tin, sandChange.vertices);
    reshaped_.clear();
    reshaped_.add(replaced);
    for (const Vertex number : others) {
        if (mesh.alive(number)) {
            aroundVertex(mesh, number, [this](std::int32_t slot, int) { reshaped_.add(slot); });
        }
    }
    const auto addBoxes = [&] {
        for (const std::int32_t slot : reshaped_.all()) {
            if (triangle(slot).alive()) {
                changedBoxes_.add(boxOf(triangle(slot)));
            }
        }
    };
    addBoxes();
    change.rim = move(tin, others);
    for (const std::int32_t slot : replaced) {
        replace(slot, drawnOf(mesh.triangles[static_cast<std::size_t>(slot)]));
    }
    for (const Vertex number : elsewhere_) {
        aroundVertex(mesh, number, [this](std::int32_t slot, int) {
            if (triangle(slot).alive()) {
                keepHome(slot);
            }
        });
    }
    addBoxes();
    const std::vector<Vertex> lit = relight(tin, reshaped_.all());
    others.insert(others.end(), lit.begin(), lit.end());
    sortOnce(others);
    change.vertices = std::move(others);
    change.boxes = changedBoxes_.take();
    return change;
}

TinVertex TinVertices::placed(const SurfaceView& tin, Vertex number) const {
    const bool known = static_cast<std::size_t>(number) < vertices_.size();
    TinVertex now = known ? vertices_[static_cast<std::size_t>(number)] : TinVertex{};
    if (!tin.triangles.alive(number)) {
        now.x = now.y = -1;
        return now;
    }
    const LatticePoint& place = tin.triangles.places[static_cast<std::size_t>(number)];
    now.x = place.x;
    now.y = place.y;
    now.height = static_cast<float>(tin.heights[static_cast<std::size_t>(number)] * unit_);
    return now;
}

/// Returns the vertices among `asked` that are new, removed, or at another place than drawn.
std::vector<Vertex> TinVertices::moved(const SurfaceView& tin, std::span<const Vertex> asked) const {
    std::vector<Vertex> others;
    for (const Vertex number : asked) {
        if (static_cast<std::size_t>(number) >= vertices_.size()) {
            continue;  // the vertex was added and removed between two updates
        }
        const TinVertex& drawn = vertices_[static_cast<std::size_t>(number)];
        const TinVertex now = placed(tin, number);
        if (drawn.x != now.x || drawn.y != now.y || drawn.height != now.height) {
            others.push_back(number);
        }
    }
    return others;
}

/// Copies places and heights of `vertices`. Returns whether the rim has changed.
bool TinVertices::move(const SurfaceView& tin, std::span<const Vertex> vertices) {
    bool rim = false;
    for (const Vertex number : vertices) {
        rim |= keepRim(number, false);
    }
    elsewhere_.clear();
    for (const Vertex number : vertices) {
        TinVertex& drawn = vertex(number);
        const TinVertex before = std::exchange(drawn, placed(tin, number));
        if (before.x != drawn.x || before.y != drawn.y) {
            moveSquare(number, before);
        }
        if (drawn.x >= 0) {
            drawn.mottling = mottlingOf(drawn.x, drawn.y);
            ever_ = around(ever_, {drawn.height, drawn.height});
            rim |= keepRim(number, true);
        }
    }
    return rim;
}

void TinVertices::moveSquare(Vertex number, const TinVertex& before) {
    const TinVertex& drawn = vertex(number);
    if (before.x >= 0) {
        squares_.remove(number, {before.x, before.y});
    }
    if (drawn.x >= 0) {
        squares_.add(number, {drawn.x, drawn.y});
        elsewhere_.push_back(number);
    }
}

/// Adds a vertex to the rim, or removes it, if it lies on the rim. Returns whether it does.
bool TinVertices::keepRim(Vertex number, bool present) {
    const TinVertex& drawn = vertex(number);
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
            rim.sides[side].emplace_back(at(number));
        }
    }
    return rim;
}

}  // namespace render_node
