// SPDX-License-Identifier: Apache-2.0
// Part of ActiveEdges: begins a run of sweeps, and selects the triangles that may slide in it.
#include <algorithm>
#include <limits>

#include "sand/tin/flow/active_edges.hpp"

namespace sand::tin {
namespace {

// A steepness below this surely rests, because kRest is above 1 and roundings are far smaller.
constexpr double kSurelyRests = 0.999;
constexpr std::int32_t kNoUnderside = std::numeric_limits<std::int32_t>::max();

}  // namespace

std::vector<Vertex> ActiveEdges::takeReleased(const Underside* held) {
    std::vector<Vertex> released;
    std::erase_if(heldBack_, [&](const Held& one) {
        if ((held != nullptr ? (*held)(one.place) : kNoUnderside) == one.underside) {
            return false;
        }
        released.push_back(one.vertex);
        noteOf(one.vertex).isHeldBack = false;
        return true;
    });
    return released;
}

double ActiveEdges::undersideAt(Vertex vertex, const LatticePoint& place) {
    if (held_ == nullptr) {
        return ActiveMesh::kFree;
    }
    VertexNote& note = noteOf(vertex);
    if (note.undersideKnown != turn_) {
        note.undersideKnown = turn_;
        const std::int32_t underside = (*held_)(place);
        note.underside = underside == kNoUnderside ? ActiveMesh::kFree : underside;
        if (underside != kNoUnderside && !note.isHeldBack) {
            note.isHeldBack = true;
            heldBack_.push_back({vertex, place, underside});
        }
    }
    return note.underside;
}

void ActiveEdges::makeRoom(std::size_t vertices, std::size_t slots) {
    ofVertices_.resize(std::max(ofVertices_.size(), vertices));
    ofSlots_.resize(std::max(ofSlots_.size(), slots));
}

void ActiveEdges::begin(const VertexSand& layer, bool band, const Underside* held) {
    band_ = band;
    held_ = held;
    swept_ = false;
    restAround_ = 0;
    makeRoom(layer.triangles().places.size(), layer.triangles().triangles.size());
    if (++turn_ == 0) {  // after 2^32 turns
        for (VertexNote& note : ofVertices_) {
            note.woken = note.undersideKnown = 0;
        }
        for (SlotNote& note : ofSlots_) {
            note.examined = 0;
        }
        turn_ = 1;
    }
    sand_.restart();
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
        const auto vertex = index(vertices_[i]);
        sand_.place(i, layer.volumes()[vertex], layer.stars()[vertex],
                    undersideAt(vertices_[i], layer.triangles().places[vertex]), layer.moving()[vertex] != 0);
    }
}

// A triangle at which no sand has flowed starts to slide at a slope that is never below the talus without slack.
bool ActiveEdges::maySlide(const VertexSand& layer, const Slopes& slopes, std::int32_t slot) {
    const Triangles& mesh = layer.triangles();
    const std::array<Vertex, 3> corners = smallestFirst(mesh.triangles[index(slot)].corner);  // as in facetOf()
    std::array<LatticePoint, 3> at;
    std::array<double, 3> heights{}, under{};
    for (std::size_t k = 0; k < 3; ++k) {
        at[k] = mesh.places[index(corners[k])];
        heights[k] = layer.heights()[index(corners[k])];
        // This records the underside although the triangle may be at rest: it may slide without the obstacle.
        under[k] = undersideAt(corners[k], at[k]);
    }
    const double x1 = at[1].x - at[0].x, y1 = at[1].y - at[0].y, x2 = at[2].x - at[0].x, y2 = at[2].y - at[0].y;
    if (held_ != nullptr) {
        lean(heights, under, x2 * x2 + y2 * y2, -2 * (x1 * x2 + y1 * y2), x1 * x1 + y1 * y1);
    }
    const double d1 = heights[1] - heights[0], d2 = heights[2] - heights[0];
    const double gx = d1 * y2 - d2 * y1, gy = d2 * x1 - d1 * x2;
    const double steepest = (x1 * y2 - x2 * y1) * slopes.slide;
    return !(gx * gx + gy * gy < kSurelyRests * steepest * steepest);
}

/// Prefetches the first data that wake() or watch() needs: those of a vertex and of a triangle at it.
void ActiveEdges::fetch(const Triangles& mesh, Vertex vertex) const {
    __builtin_prefetch(&ofVertices_[index(vertex)]);
    if (mesh.alive(vertex)) {
        const std::int32_t slot = mesh.triangleAt[index(vertex)];
        __builtin_prefetch(&ofSlots_[index(slot)]);
        __builtin_prefetch(&mesh.triangles[index(slot)]);
    }
}

/// Prefetches the neighbours of the triangle that fetch() has loaded for a vertex.
void ActiveEdges::fetchBeside(const Triangles& mesh, Vertex vertex) const {
    if (mesh.alive(vertex)) {
        for (const std::int32_t slot : mesh.triangles[index(mesh.triangleAt[index(vertex)])].neighbour) {
            __builtin_prefetch(&mesh.triangles[index(std::max(slot, 0))]);
            __builtin_prefetch(&ofSlots_[index(std::max(slot, 0))]);
        }
    }
}

void ActiveEdges::wake(const VertexSand& layer, const Slopes& slopes, std::span<const Vertex> vertices) {
    const Triangles& mesh = layer.triangles();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const Vertex vertex = vertices[i];
        if (i + 2 * kAhead < vertices.size()) {
            fetch(mesh, vertices[i + 2 * kAhead]);
        }
        if (i + kAhead < vertices.size()) {
            fetchBeside(mesh, vertices[i + kAhead]);
        }
        if (!mesh.alive(vertex) || noteOf(vertex).woken == turn_) {
            continue;
        }
        noteOf(vertex).woken = turn_;
        if (layer.moving()[index(vertex)] != 0) {
            moving_.push_back(vertex);
        }
        if (layer.volumes()[index(vertex)] > 0 && spills(mesh, vertex)) {
            watch(layer, slopes, vertex);  // because level sand falls over the rim too
        }
        aroundVertex(mesh, vertex, [&](std::int32_t slot, int) {
            std::uint32_t& examined = noteOfSlot(slot).examined;
            if (examined == turn_ || mesh.triangles[index(slot)].hole) {
                return;
            }
            examined = turn_;
            if (maySlide(layer, slopes, slot)) {
                (isHeld(mesh.triangles[index(slot)]) ? steepHeld_ : steep_).push_back(slot);
            }
        });
    }
    // Add the held triangles together, so that few of the others share a group with them and are swept as held.
    for (auto* slots : {&steepHeld_, &steep_}) {
        for (const std::int32_t slot : *slots) {
            static_cast<void>(facetAt(layer, slopes, slot));
        }
        slots->clear();
    }
}
}  // namespace sand::tin
