// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/active_edges.hpp"

#include <algorithm>
#include <limits>

namespace sand::tin {
namespace {

constexpr double kSurelyRests = 0.999;      // of a steepness of 1: kRest is above it, and roundings are far smaller
constexpr std::size_t kSweepsToForget = 5;  // of all sand: what it costs to forget some of it
constexpr std::size_t kOfVerticesRest = 6;  // around what flows a ring lies still: so much of a lump of 1000 vertices
constexpr int kAllSides = 3;                // the bit, of a slot, that says that all its sides are watched
constexpr std::int32_t kNoUnderside = std::numeric_limits<std::int32_t>::max();

std::size_t index(std::int32_t number) { return static_cast<std::size_t>(number); }

/// The side with its corner counted from the triangle's smallest vertex on: a slot may turn its corners unnoticed.
Side counted(const Triangles& mesh, Side side) {
    const auto& [a, b, c] = mesh.triangles[index(side.triangle)].corner;
    const int least = a < b ? (a < c ? 0 : 2) : (b < c ? 1 : 2);
    return {side.triangle, (side.corner - least + 3) % 3};
}

}  // namespace

std::vector<Vertex> ActiveEdges::takeReleased(const Underside* held) {
    std::vector<Vertex> released;
    std::erase_if(heldBack_, [&](const Held& one) {
        if ((held != nullptr ? (*held)(one.place) : kNoUnderside) == one.underside) {
            return false;
        }
        released.push_back(one.vertex);
        isHeldBack_[index(one.vertex)] = 0;
        return true;
    });
    return released;
}

double ActiveEdges::undersideAt(Vertex vertex, const Place& place) {
    if (held_ == nullptr) {
        return MovingSand::kFree;
    }
    double& known = undersides_[index(vertex)];
    if (knownUndersides_.insert(vertex)) {
        const std::int32_t underside = (*held_)(place);
        known = underside == kNoUnderside ? MovingSand::kFree : underside;
        if (underside != kNoUnderside && isHeldBack_[index(vertex)] == 0) {
            isHeldBack_[index(vertex)] = 1;
            heldBack_.push_back({vertex, place, underside});
        }
    }
    return known;
}

void ActiveEdges::makeRoom(std::size_t vertices, std::size_t slots) {
    local_.resize(std::max(local_.size(), vertices), kNobody);
    isHeldBack_.resize(local_.size(), 0);
    undersides_.resize(local_.size(), 0);
    knownUndersides_.reserve(local_.size());
    wokenOnce_.reserve(local_.size());
    facet_.resize(std::max(facet_.size(), slots), kNobody);
    watchedSides_.resize(facet_.size(), 0);
    examined_.reserve(facet_.size());
}

void ActiveEdges::begin(const Layer& layer, bool band, const Underside* held) {
    band_ = band;
    held_ = held;
    makeRoom(layer.triangles().places.size(), layer.triangles().triangles.size());
    knownUndersides_.clear();
    sand_.restart();
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
        const auto vertex = index(vertices_[i]);
        sand_.place(i, layer.volumes()[vertex], layer.stars()[vertex],
                    undersideAt(vertices_[i], layer.triangles().places[vertex]));
    }
}

std::int32_t ActiveEdges::localOf(const Layer& layer, Vertex vertex) {
    const auto at = index(vertex);
    if (local_[at] == kNobody) {
        local_[at] =
            sand_.addVertex(layer.volumes()[at], layer.stars()[at], undersideAt(vertex, layer.triangles().places[at]));
        vertices_.push_back(vertex);
    }
    return local_[at];
}

std::int32_t ActiveEdges::facetAt(const Layer& layer, const Slopes& slopes, std::int32_t slot) {
    std::int32_t& number = facet_[index(slot)];
    if (number == kNobody) {
        Facet facet = facetOf(layer.triangles(), slot, slopes);
        for (Vertex& corner : facet.corner) {
            corner = localOf(layer, corner);
        }
        number = sand_.addFacet(facet);
        slots_.push_back(slot);
    }
    return number;
}

void ActiveEdges::watch(const Layer& layer, const Slopes& slopes, Weights& weights, Vertex vertex) {
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
            watchTriangle(layer, slopes, weights, slot);
        }
    });
}

void ActiveEdges::watchTriangle(const Layer& layer, const Slopes& slopes, Weights& weights, std::int32_t slot) {
    const Triangles& mesh = layer.triangles();
    if ((watchedSides_[index(slot)] >> kAllSides & 1) != 0) {
        return;
    }
    watchedSides_[index(slot)] = static_cast<std::uint8_t>(watchedSides_[index(slot)] | 1 << kAllSides);
    for (int corner = 0; corner < 3; ++corner) {
        const Side side = owner(mesh, {slot, corner});
        const Side named = counted(mesh, side);
        std::uint8_t& watched = watchedSides_[index(side.triangle)];
        if ((watched >> named.corner & 1) == 0) {
            watched = static_cast<std::uint8_t>(watched | 1 << named.corner);
            Edge edge = weights.edge(mesh, layer.stars(), side);
            edge.from = localOf(layer, edge.from);
            edge.to = localOf(layer, edge.to);
            edge.leftFacet = facetAt(layer, slopes, edge.leftFacet);
            edge.rightFacet = facetAt(layer, slopes, edge.rightFacet);
            sand_.addEdge(edge);
            sides_.push_back(named);
        }
    }
}

// Where nothing has flowed before, a triangle slides from a slope on that is never below the one without slack, and an
// edge of two triangles that do not slide carries nothing.
bool ActiveEdges::maySlide(const Layer& layer, const Slopes& slopes, std::int32_t slot) {
    const Triangles& mesh = layer.triangles();
    std::array<Place, 3> at;
    std::array<double, 3> was{}, under{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Vertex corner = mesh.triangles[index(slot)].corner[k];
        at[k] = mesh.places[index(corner)];
        was[k] = layer.heights()[index(corner)];
        under[k] = undersideAt(corner, at[k]);  // noted, though the triangle may not slide: it may without the obstacle
    }
    const double a = leaning(was[0], under[0], was[1], was[2]), b = leaning(was[1], under[1], was[2], was[0]);
    const double c = leaning(was[2], under[2], was[0], was[1]);
    const double x1 = at[1].x - at[0].x, y1 = at[1].y - at[0].y, x2 = at[2].x - at[0].x, y2 = at[2].y - at[0].y;
    const double gx = (b - a) * y2 - (c - a) * y1, gy = (c - a) * x1 - (b - a) * x2;
    const double steepest = (x1 * y2 - x2 * y1) * slopes.slide;
    return !(gx * gx + gy * gy < kSurelyRests * steepest * steepest);
}

void ActiveEdges::wake(const Layer& layer, const Slopes& slopes, Weights& weights, std::span<const Vertex> vertices) {
    examined_.clear();
    wokenOnce_.clear();
    for (const Vertex vertex : vertices) {
        if (layer.triangles().alive(vertex) && wokenOnce_.insert(vertex)) {
            aroundVertex(layer.triangles(), vertex, [&](std::int32_t slot, int) {
                if (!layer.triangles().triangles[index(slot)].hole && examined_.insert(slot) &&
                    maySlide(layer, slopes, slot)) {
                    watchTriangle(layer, slopes, weights, slot);
                }
            });
        }
    }
}

// Where no volume changes no height does, and a flux is what it was; but with a band, sand that flows through moves
// what it touches.
bool ActiveEdges::sweep(const Layer& layer, const Slopes& slopes, Weights& weights) {
    const SweepResult result = sand_.sweep(held_ != nullptr, band_);
    if (result.spread || (band_ && result.moved && result.met)) {
        met_.clear();
        sand_.findUnwatched(met_);
        for (const std::int32_t local : met_) {
            watch(layer, slopes, weights, vertices_[index(local)]);
        }
    }
    inVain_ = std::max<std::int64_t>(
        inVain_ + result.resting - static_cast<std::int64_t>(sand_.vertexCount() / kOfVerticesRest), 0);
    return result.moved;
}

void ActiveEdges::store(Layer& layer, std::vector<Vertex>& moved) const {
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
        const Vertex vertex = vertices_[i];
        if (const std::int64_t risen = sand_.volume(i) - layer.volumes()[index(vertex)]; risen != 0) {
            layer.add(vertex, risen);
            moved.push_back(vertex);
        }
    }
}

bool ActiveEdges::manyRest() const {
    return inVain_ > static_cast<std::int64_t>(kSweepsToForget * sand_.vertexCount());
}

void ActiveEdges::keepEdges(const std::vector<std::uint8_t>& kept) {
    if (std::find(kept.begin(), kept.end(), 0) == kept.end()) {
        return;
    }
    const auto forget = [this](std::int32_t slot, int bit) {
        std::uint8_t& watched = watchedSides_[index(slot)];
        watched = static_cast<std::uint8_t>(watched & ~(1 << bit));
    };
    std::size_t edges = 0;
    for (std::size_t i = 0; i < sides_.size(); ++i) {
        if (kept[i] != 0) {
            sides_[edges++] = sides_[i];
            continue;
        }
        const Edge edge = sand_.edge(i);
        forget(sides_[i].triangle, sides_[i].corner);
        forget(slots_[index(edge.leftFacet)], kAllSides);
        forget(slots_[index(edge.rightFacet)], kAllSides);
    }
    sides_.resize(edges);
    const MovingSand::Renumbering now = sand_.keepEdges(kept);
    const auto renumber = [](std::vector<std::int32_t>& names, const std::vector<std::int32_t>& by,
                             std::vector<std::int32_t>& local, std::size_t count) {
        for (std::size_t i = 0; i < names.size(); ++i) {
            local[index(names[i])] = by[i];
            if (by[i] != kNobody) {
                names[index(by[i])] = names[i];
            }
        }
        names.resize(count);
    };
    renumber(vertices_, now.vertices, local_, sand_.vertexCount());
    renumber(slots_, now.facets, facet_, sand_.facetCount());
}

void ActiveEdges::forgetResting() {
    inVain_ = 0;
    std::vector<std::uint8_t> facetFlows(sand_.facetCount()), kept(sand_.edgeCount());
    for (std::size_t i = 0; i < facetFlows.size(); ++i) {
        const auto [a, b, c] = sand_.facet(static_cast<std::int32_t>(i)).corner;
        facetFlows[i] = sand_.flowed(index(a)) || sand_.flowed(index(b)) || sand_.flowed(index(c)) ? 1 : 0;
    }
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const Edge edge = sand_.edge(i);
        kept[i] = facetFlows[index(edge.leftFacet)] | facetFlows[index(edge.rightFacet)];
    }
    for (std::size_t i = 0; i < sand_.vertexCount(); ++i) {
        sand_.setWatched(i, sand_.flowed(i));
    }
    keepEdges(kept);
}

std::vector<Vertex> ActiveEdges::meshChanged(const Mesh::Change& change) {
    std::erase_if(heldBack_, [&](const Held& one) {
        const bool gone = std::binary_search(change.vertices.begin(), change.vertices.end(), one.vertex);
        isHeldBack_[index(one.vertex)] = gone ? 0 : 1;
        return gone;
    });
    std::vector<std::uint8_t> staleVertices(sand_.vertexCount()), staleFacets(sand_.facetCount());
    for (const Vertex vertex : change.vertices) {
        if (index(vertex) < local_.size() && local_[index(vertex)] != kNobody) {
            staleVertices[index(local_[index(vertex)])] = 1;
        }
    }
    for (const std::int32_t slot : change.triangles) {
        if (index(slot) < facet_.size() && facet_[index(slot)] != kNobody) {
            staleFacets[index(facet_[index(slot)])] = 1;
        }
    }
    std::vector<Vertex> ends;
    std::vector<std::uint8_t> kept(sand_.edgeCount());
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const Edge edge = sand_.edge(i);
        kept[i] = (staleVertices[index(edge.from)] | staleVertices[index(edge.to)] |
                   staleFacets[index(edge.leftFacet)] | staleFacets[index(edge.rightFacet)]) == 0;
        if (kept[i] == 0) {
            ends.insert(ends.end(), {vertices_[index(edge.from)], vertices_[index(edge.to)]});
            for (const std::int32_t facet : {edge.leftFacet, edge.rightFacet}) {
                for (const std::int32_t corner : sand_.facet(facet).corner) {
                    sand_.setWatched(index(corner), false);
                }
            }
        }
    }
    keepEdges(kept);
    return ends;
}

void ActiveEdges::clear() { keepEdges(std::vector<std::uint8_t>(sand_.edgeCount(), 0)); }

}  // namespace sand::tin
