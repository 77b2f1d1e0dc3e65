// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/flow/active_edges.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace sand::tin {
namespace {

// A steepness below this surely rests, because kRest is above 1 and roundings are far smaller.
constexpr double kSurelyRests = 0.999;
// A ring around flowing sand lies still: at least one vertex in so many is at rest.
constexpr std::size_t kOfVerticesRest = 6;
constexpr std::uint8_t kAllSides = 7;  // bits of all three sides
constexpr std::size_t kAhead = 8;      // distance from a prefetch to its use [vertex]
constexpr std::int32_t kNoUnderside = std::numeric_limits<std::int32_t>::max();

/// Returns the bit of a side. Corners count from the triangle's smallest vertex, because a slot may rotate its corners
/// without notice.
std::uint8_t bitOf(const Triangles& mesh, TriangleSide side) {
    const int least = leastOf(mesh.triangles[index(side.triangle)].corner);
    return static_cast<std::uint8_t>(1 << (side.corner - least + 3) % 3);
}

constexpr std::size_t kSweepsToForget = 5;  // of all active sand; they take as long as forgetting a part of it

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

bool ActiveEdges::manyRest() const {
    return restingVisits_ > static_cast<std::int64_t>(kSweepsToForget * sand_.vertexCount());
}

void ActiveEdges::keep(const ActiveMesh::Marks& kept) {
    const auto areAll = [](const std::vector<std::uint8_t>& marks) {
        return std::find(marks.begin(), marks.end(), 0) == marks.end();
    };
    if (areAll(kept.facets) && areAll(kept.edges)) {
        return;
    }
    const auto forget = [this](std::int32_t facet, std::uint8_t bit) {
        std::uint8_t& watched = noteOfSlot(slots_[index(facet)]).watched;
        watched = static_cast<std::uint8_t>(watched & ~bit);
    };
    std::size_t edges = 0;
    for (std::size_t i = 0; i < bits_.size(); ++i) {
        if (kept.edges[i] != 0) {
            bits_[edges++] = bits_[i];
            continue;
        }
        const Edge edge = sand_.edge(i);
        forget(edge.leftFacet, bits_[i].left);
        forget(edge.rightFacet, bits_[i].right);
    }
    bits_.resize(edges);
    const ActiveMesh::Renumbering now = sand_.keep(kept);
    const auto renumber = [](std::vector<std::int32_t>& names, const std::vector<std::int32_t>& by, const auto& local,
                             std::size_t count) {
        for (std::size_t i = 0; i < names.size(); ++i) {
            local(names[i]) = by[i];
            if (by[i] != kNoNumber) {
                names[index(by[i])] = names[i];
            }
        }
        names.resize(count);
    };
    const auto localOf = [this](Vertex vertex) -> std::int32_t& { return noteOf(vertex).local; };
    const auto facetOf = [this](std::int32_t slot) -> std::int32_t& { return noteOfSlot(slot).facet; };
    renumber(vertices_, now.vertices, localOf, sand_.vertexCount());
    renumber(slots_, now.facets, facetOf, sand_.facetCount());
}

void ActiveEdges::forgetResting() {
    restingVisits_ = 0;
    for (std::size_t i = 0; i < sand_.vertexCount(); ++i) {
        sand_.setWatched(i, sand_.flowed(i));
    }
    keep(sand_.whatMayFlow());
    restAround_ = sand_.restingCount();
}

std::vector<Vertex> ActiveEdges::meshChanged(const Mesh::Change& change) {
    std::erase_if(heldBack_, [&](const Held& one) {
        const bool gone = std::binary_search(change.vertices.begin(), change.vertices.end(), one.vertex);
        noteOf(one.vertex).isHeldBack = !gone;
        return gone;
    });
    ActiveMesh::Marks kept{std::vector<std::uint8_t>(sand_.facetCount(), 1),
                           std::vector<std::uint8_t>(sand_.edgeCount())};
    std::vector<std::uint8_t> staleVertices(sand_.vertexCount());
    for (const Vertex vertex : change.vertices) {
        if (index(vertex) < ofVertices_.size() && noteOf(vertex).local != kNoNumber) {
            staleVertices[index(noteOf(vertex).local)] = 1;
        }
    }
    std::vector<Vertex> corners;
    for (const std::int32_t slot : change.triangles) {
        if (index(slot) < ofSlots_.size() && noteOfSlot(slot).facet != kNoNumber) {
            kept.facets[index(noteOfSlot(slot).facet)] = 0;
            for (const std::int32_t corner : sand_.facet(noteOfSlot(slot).facet).corner) {
                corners.push_back(vertices_[index(corner)]);
                sand_.setWatched(index(corner), false);
            }
        }
    }
    // The weights of an edge depend on all corners of its facets.
    std::vector<std::uint8_t> known = kept.facets;
    for (std::size_t i = 0; i < known.size(); ++i) {
        for (const std::int32_t corner : sand_.facet(static_cast<std::int32_t>(i)).corner) {
            known[i] = staleVertices[index(corner)] != 0 ? 0 : known[i];
        }
    }
    for (std::size_t i = 0; i < kept.edges.size(); ++i) {
        const Edge edge = sand_.edge(i);
        kept.edges[i] = known[index(edge.leftFacet)] & known[index(edge.rightFacet)];
    }
    keep(kept);
    return corners;
}

void ActiveEdges::clear() {
    keep({std::vector<std::uint8_t>(sand_.facetCount()), std::vector<std::uint8_t>(sand_.edgeCount())});
}

}  // namespace sand::tin
