// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/flow/active_edges.hpp"

#include <algorithm>
#include <utility>

namespace sand::tin {
namespace {

// A ring around flowing sand lies still: at least one vertex in so many is at rest.
constexpr std::size_t kOfVerticesRest = 6;
constexpr std::uint8_t kAllSides = 7;  // bits of all three sides

/// Returns the bit of a side. Corners count from the triangle's smallest vertex, because a slot may rotate its corners
/// without notice.
std::uint8_t bitOf(const Triangles& mesh, TriangleSide side) {
    const int least = leastOf(mesh.triangles[index(side.triangle)].corner);
    return static_cast<std::uint8_t>(1 << (side.corner - least + 3) % 3);
}

}  // namespace

std::int32_t ActiveEdges::localOf(const VertexSand& layer, Vertex vertex) {
    std::int32_t& local = noteOf(vertex).local;
    if (local == kNoNumber) {
        const auto at = index(vertex);
        local =
            sand_.addVertex(layer.volumes()[at], layer.stars()[at], undersideAt(vertex, layer.triangles().places[at]),
                            spills(layer.triangles(), vertex), !swept_ && layer.moving()[at] != 0);
        vertices_.push_back(vertex);
    }
    return local;
}

std::int32_t ActiveEdges::facetAt(const VertexSand& layer, const Slopes& slopes, std::int32_t slot) {
    std::int32_t& number = noteOfSlot(slot).facet;
    if (number == kNoNumber) {
        Facet facet = facetOf(layer.triangles(), slot, slopes);
        for (Vertex& corner : facet.corner) {
            corner = localOf(layer, corner);
        }
        number = sand_.addFacet(facet);
        slots_.push_back(slot);
    }
    return number;
}

void ActiveEdges::watch(const VertexSand& layer, const Slopes& slopes, Vertex vertex) {
    const Triangles& mesh = layer.triangles();
    if (!mesh.alive(vertex) || layer.stars()[index(vertex)] == 0) {
        return;
    }
    const std::int32_t self = localOf(layer, vertex);
    if (sand_.isWatched(index(self))) {
        return;
    }
    sand_.setWatched(index(self), true);
    aroundVertex(mesh, vertex, [&](std::int32_t slot, int) {
        if (!mesh.triangles[index(slot)].hole) {
            static_cast<void>(facetAt(layer, slopes, slot));
        }
    });
}

void ActiveEdges::watchEdges(const VertexSand& layer, const Slopes& slopes, Weights& weights, std::int32_t slot) {
    const Triangles& mesh = layer.triangles();
    std::uint8_t& watched = noteOfSlot(slot).watched;
    for (int corner = 0; corner < 3 && watched != kAllSides; ++corner) {
        const TriangleSide side{slot, corner};
        const std::uint8_t bit = bitOf(mesh, side);
        if ((watched & bit) != 0) {
            continue;
        }
        const TriangleSide other = across(mesh, side);
        watched = static_cast<std::uint8_t>(watched | bit);
        bits_.push_back({bit, bit});
        if (other.triangle != kNoNumber) {
            bits_.back().right = bitOf(mesh, other);
            std::uint8_t& beyond = noteOfSlot(other.triangle).watched;
            beyond = static_cast<std::uint8_t>(beyond | bits_.back().right);
        }
        Edge edge = weights.edge(mesh, layer.stars(), side, other);
        edge.from = localOf(layer, edge.from);
        edge.to = localOf(layer, edge.to);
        edge.leftFacet = facetAt(layer, slopes, edge.leftFacet);
        edge.rightFacet = facetAt(layer, slopes, edge.rightFacet);
        sand_.addEdge(edge);
    }
}

bool ActiveEdges::isHeld(const Triangle& triangle) {
    return held_ != nullptr && std::any_of(triangle.corner.begin(), triangle.corner.end(), [this](Vertex corner) {
               return noteOf(corner).underside < ActiveMesh::kFree;
           });
}

// No triangle slides beside an unwatched edge. If no sand flows around a triangle, its heights stay, and it does not
// start to slide. Sand that flows through a vertex may set the sand that it touches in motion, or keep it in motion.
bool ActiveEdges::sweep(const VertexSand& layer, const Slopes& slopes, Weights& weights, double momentum) {
    std::size_t known = 0;
    do {
        const std::size_t first = std::exchange(known, sand_.facetCount());
        for (const std::int32_t facet : sand_.slide(held_ != nullptr, band_, momentum, first)) {
            watchEdges(layer, slopes, weights, slots_[index(facet)]);
            sand_.setBare(index(facet), false);
        }
        // A facet that was added with an edge may slide too. Under an obstacle, no sand may have flowed around it
        // before.
    } while (known < sand_.facetCount());
    const SweepResult result = sand_.move(held_ != nullptr);
    swept_ = true;
    outflow_ += result.outflow;
    if (result.met) {
        met_.clear();
        sand_.findUnwatched(met_);
        for (std::size_t i = 0; i < met_.size(); ++i) {
            if (i + kAhead < met_.size()) {
                fetch(layer.triangles(), vertices_[index(met_[i + kAhead])]);
            }
            watch(layer, slopes, vertices_[index(met_[i])]);
        }
    }
    const std::int64_t around = std::max(restAround_, static_cast<std::int64_t>(sand_.vertexCount() / kOfVerticesRest));
    restingVisits_ = std::max<std::int64_t>(restingVisits_ + result.resting - around, 0);
    return result.moved;
}

void ActiveEdges::store(VertexSand& layer, std::vector<Vertex>& moved) const {
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
        const Vertex vertex = vertices_[i];
        if (const std::int64_t risen = sand_.volume(i) - layer.volumes()[index(vertex)]; risen != 0) {
            layer.add(vertex, risen);
            moved.push_back(vertex);
        }
    }
}

void ActiveEdges::storeMotion(VertexSand& layer, std::vector<Vertex>& changed) {
    const auto flows = [&](Vertex vertex) {
        const std::int32_t local = noteOf(vertex).local;
        return swept_ && local != kNoNumber && sand_.flowed(index(local));
    };
    for (const Vertex vertex : moving_) {
        if (layer.moving()[index(vertex)] != 0 && !flows(vertex)) {
            layer.setMoving(vertex, false);
            changed.push_back(vertex);
        }
    }
    moving_.clear();
    for (std::size_t i = 0; swept_ && i < vertices_.size(); ++i) {
        if (sand_.flowed(i)) {
            moving_.push_back(vertices_[i]);
            if (layer.moving()[index(vertices_[i])] == 0) {
                layer.setMoving(vertices_[i], true);
                changed.push_back(vertices_[i]);
            }
        }
    }
}
}  // namespace sand::tin
