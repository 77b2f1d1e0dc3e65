// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/active_edges.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace sand::tin {
namespace {

// A triangle slides by c = kPush (s − 1)/(s + 1), s = m²/g²: near g as 1 − g/m does, without its root. Sweeps descend
// the energy whose derivative is m c, and a descent neither overshoots nor swings while step times curvature is at most
// 2: Σ k ≤ star allows 1, and m c bends by at most 1.25 kPush. With 1 − g²/m² and 0.9, of curvature 1.8, sand swings.
constexpr double kPush = 0.8;
// Sand stays where its slope is steeper than g by less than a part in 2048: it would creep there for many thousand
// sweeps, at heights that nobody tells apart. A grid's rest slopes are off by three times as much.
constexpr double kRest = 1 + 1.0 / 1024;

std::size_t index(std::int32_t number) { return static_cast<std::size_t>(number); }

/// `value` or zero, without a branch: processors foresee sand badly, and to be wrong costs as much as ten such
/// products.
double onlyIf(bool condition, double value) {
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) & -static_cast<std::uint64_t>(condition));
}

double heightOf(std::int64_t volume, double star) { return static_cast<double>(volume) / star; }

}  // namespace

void ActiveEdges::begin(const Layer& layer, bool band, const Underside* held) {
    band_ = band;
    held_ = held;
    for (std::size_t i = 0; i < locals_.size(); ++i) {
        Local& local = locals_[i];
        local.underside = held_ != nullptr ? (*held_)(local.place) : 0;
        sands_[i].volume = layer.volumes()[index(local.vertex)];
        heights_[i] = heightOf(sands_[i].volume, sands_[i].star);
    }
    std::fill(flowed_.begin(), flowed_.end(), 0);
}

std::int32_t ActiveEdges::localOf(const Layer& layer, Vertex vertex) {
    if (index(vertex) >= local_.size()) {
        local_.resize(layer.triangles().places.size(), kNobody);
    }
    std::int32_t& local = local_[index(vertex)];
    if (local == kNobody) {
        local = static_cast<std::int32_t>(locals_.size());
        locals_.push_back({.vertex = vertex,
                           .place = layer.triangles().places[index(vertex)],
                           .underside = held_ != nullptr ? (*held_)(layer.triangles().places[index(vertex)]) : 0.0});
        sands_.push_back({layer.volumes()[index(vertex)], static_cast<double>(layer.stars()[index(vertex)])});
        heights_.push_back(heightOf(sands_.back().volume, sands_.back().star));
        inflow_.push_back({});
        flowed_.push_back(0);
    }
    return local;
}

std::int32_t ActiveEdges::facetAt(const Layer& layer, const Slopes& slopes, std::int32_t slot) {
    std::int32_t& number = facet_[index(slot)];
    if (number == kNobody) {
        number = static_cast<std::int32_t>(facets_.size());
        facets_.push_back(facetOf(layer.triangles(), slot, slopes));
        slots_.push_back(slot);
        sliding_.push_back(0);
        for (Vertex& corner : facets_.back().corner) {
            corner = localOf(layer, corner);
        }
    }
    return number;
}

void ActiveEdges::watch(const Layer& layer, const Slopes& slopes, Weights& weights, Vertex vertex) {
    const Triangles& mesh = layer.triangles();
    if (!mesh.alive(vertex)) {
        return;
    }
    const std::int32_t self = localOf(layer, vertex);
    if (locals_[index(self)].watched) {
        return;
    }
    locals_[index(self)].watched = true;
    watchedSides_.resize(std::max(watchedSides_.size(), mesh.triangles.size()));
    facet_.resize(watchedSides_.size(), kNobody);
    aroundVertex(mesh, vertex, [&](std::int32_t slot, int) {
        for (int corner = 0; corner < 3; ++corner) {
            const Side side = owner(mesh, {slot, corner});
            std::uint8_t& watched = watchedSides_[index(side.triangle)];
            if ((watched >> side.corner & 1) == 0) {
                watched = static_cast<std::uint8_t>(watched | 1 << side.corner);
                Edge edge = weights.edge(mesh, layer.stars(), side);
                edge.from = localOf(layer, edge.from);
                edge.to = localOf(layer, edge.to);
                edge.leftFacet = facetAt(layer, slopes, edge.leftFacet);
                edge.rightFacet = facetAt(layer, slopes, edge.rightFacet);
                edges_.push_back(edge);
                sides_.push_back(side);
            }
        }
    });
}

double ActiveEdges::steepnessAtHeld(const Facet& facet) {
    std::array<double, 3> height{};
    std::array<bool, 3> full{};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto corner = index(facet.corner[k]);
        height[k] = heights_[corner];
        full[k] = height[k] > locals_[corner].underside - 1;
        locals_[corner].heldBack |= full[k];
    }
    std::array<double, 3> leaning = height;
    for (std::size_t k = 0; k < 3; ++k) {
        if (full[k]) {
            leaning[k] = std::max(height[k], std::min(height[(k + 1) % 3], height[(k + 2) % 3]));
        }
    }
    return facet.steepness(leaning[1] - leaning[0], leaning[2] - leaning[0]);
}

template <bool kBand, bool kHeld>
void ActiveEdges::slide() {
    const double* const height = heights_.data();
    double* sliding = sliding_.data();
    for (const Facet& facet : facets_) {
        const auto [a, b, c] = facet.corner;
        double steepness = facet.steepness(height[b] - height[a], height[c] - height[a]);
        if constexpr (kHeld) {
            steepness = steepnessAtHeld(facet);
        }
        double rest = kRest;
        if constexpr (kBand) {
            rest = (flowed_[index(a)] | flowed_[index(b)] | flowed_[index(c)]) != 0 ? kRest : facet.start;
        }
        *sliding++ = onlyIf(steepness > rest, kPush - 2 * kPush / (steepness + 1));
    }
}

template <bool kHeld>
void ActiveEdges::flow() {
    const double* const height = heights_.data();
    const double* const sliding = sliding_.data();
    Inflow* const inflow = inflow_.data();
    for (const Edge& edge : edges_) {
        const double share = edge.left * sliding[edge.leftFacet] + edge.right * sliding[edge.rightFacet];
        const double difference = height[edge.from] - height[edge.to];
        auto flux = static_cast<std::int64_t>(onlyIf(share > 0, share) * difference);
        if constexpr (kHeld) {
            flux = underHeld(edge, difference, flux);
        }
        inflow[edge.from].net -= flux;
        inflow[edge.from].any |= flux;
        inflow[edge.to].net += flux;
        inflow[edge.to].any |= flux;
    }
}

std::int64_t ActiveEdges::underHeld(const Edge& edge, double difference, std::int64_t flux) {
    if (flux == 0) {
        return 0;
    }
    const std::int32_t lower = difference > 0 ? edge.to : edge.from;
    const double limit = std::max(edge.left, 0.0) + std::max(edge.right, 0.0);
    Local& below = locals_[index(lower)];
    const auto room = static_cast<std::int64_t>(limit * std::max(below.underside - heights_[index(lower)], 0.0));
    if (std::abs(flux) <= room) {
        return flux;
    }
    below.heldBack = true;
    return flux < 0 ? -room : room;
}

bool ActiveEdges::sweep() {
    if (held_ != nullptr) {
        band_ ? slide<true, true>() : slide<false, true>();
        flow<true>();
    } else {
        band_ ? slide<true, false>() : slide<false, false>();
        flow<false>();
    }
    Inflow* const inflows = inflow_.data();
    Sand* const sands = sands_.data();
    double* const heights = heights_.data();
    std::uint8_t* const flowed = flowed_.data();
    std::int64_t any = 0;
    const std::size_t count = locals_.size();
    for (std::size_t i = 0; i < count; ++i) {
        any |= inflows[i].any;
        flowed[i] = inflows[i].any != 0;
        sands[i].volume += inflows[i].net;
        heights[i] = heightOf(sands[i].volume, sands[i].star);
        inflows[i] = {};
    }
    return any != 0;
}

void ActiveEdges::spread(const Layer& layer, const Slopes& slopes, Weights& weights) {
    for (std::size_t i = 0; i < locals_.size(); ++i) {
        if (flowed_[i] != 0 && !locals_[i].watched) {
            watch(layer, slopes, weights, locals_[i].vertex);
        }
    }
}

void ActiveEdges::store(Layer& layer, std::vector<Vertex>& moved) {
    for (std::size_t i = 0; i < locals_.size(); ++i) {
        Local& local = locals_[i];
        if (const std::int64_t risen = sands_[i].volume - layer.volumes()[index(local.vertex)]; risen != 0) {
            layer.add(local.vertex, risen);
            moved.push_back(local.vertex);
        }
        if (local.heldBack) {
            heldBack_.push_back(local.vertex);
            local.heldBack = false;
        }
    }
}

bool ActiveEdges::mostRest() const {
    const auto flowed = std::count_if(flowed_.begin(), flowed_.end(), [](std::uint8_t one) { return one != 0; });
    // Of what is watched around a lump of 1000 vertices, 85 % have flowed.
    return static_cast<std::size_t>(2 * flowed) < flowed_.size();
}

void ActiveEdges::forgetResting() {
    // What is kept is numbered anew, in the order in which the edges that stay name it.
    ActiveEdges kept;
    std::vector<std::int32_t> locals(locals_.size(), kNobody), facets(facets_.size(), kNobody);
    const auto flowed = [this](std::int32_t local) { return flowed_[index(local)] != 0; };
    const auto keepLocal = [&](std::int32_t& number) {
        std::int32_t& now = locals[index(number)];
        if (now == kNobody) {
            now = static_cast<std::int32_t>(kept.locals_.size());
            kept.locals_.push_back(locals_[index(number)]);
            kept.locals_.back().watched = flowed(number);
            kept.sands_.push_back(sands_[index(number)]);
            kept.heights_.push_back(heights_[index(number)]);
            kept.flowed_.push_back(flowed_[index(number)]);
        }
        number = now;
    };
    const auto keepFacet = [&](std::int32_t& number) {
        std::int32_t& now = facets[index(number)];
        if (now == kNobody) {
            now = static_cast<std::int32_t>(kept.facets_.size());
            kept.facets_.push_back(facets_[index(number)]);
            kept.slots_.push_back(slots_[index(number)]);
            for (Vertex& corner : kept.facets_.back().corner) {
                keepLocal(corner);
            }
        }
        number = now;
    };
    for (std::size_t e = 0; e < edges_.size(); ++e) {
        Edge edge = edges_[e];
        const auto flows = [&](std::int32_t facet) {
            const auto& corner = facets_[index(facet)].corner;
            return flowed(corner[0]) || flowed(corner[1]) || flowed(corner[2]);
        };
        if (!flows(edge.leftFacet) && !flows(edge.rightFacet)) {
            std::uint8_t& watched = watchedSides_[index(sides_[e].triangle)];
            watched = static_cast<std::uint8_t>(watched & ~(1 << sides_[e].corner));
            continue;
        }
        keepLocal(edge.from);
        keepLocal(edge.to);
        keepFacet(edge.leftFacet);
        keepFacet(edge.rightFacet);
        kept.edges_.push_back(edge);
        kept.sides_.push_back(sides_[e]);
    }
    for (std::size_t i = 0; i < locals_.size(); ++i) {
        local_[index(locals_[i].vertex)] = locals[i];
    }
    for (std::size_t i = 0; i < facets_.size(); ++i) {
        facet_[index(slots_[i])] = facets[i];
    }
    edges_.swap(kept.edges_);
    sides_.swap(kept.sides_);
    locals_.swap(kept.locals_);
    facets_.swap(kept.facets_);
    slots_.swap(kept.slots_);
    sands_.swap(kept.sands_);
    heights_.swap(kept.heights_);
    flowed_.swap(kept.flowed_);
    sliding_.assign(facets_.size(), 0);
    inflow_.assign(locals_.size(), {});
}

std::vector<Vertex> ActiveEdges::clear() {
    std::vector<Vertex> result;
    for (std::size_t i = 0; i < locals_.size(); ++i) {
        if (flowed_[i] != 0) {
            result.push_back(locals_[i].vertex);
        }
        local_[index(locals_[i].vertex)] = kNobody;
    }
    for (const Side& side : sides_) {
        watchedSides_[index(side.triangle)] = 0;
    }
    for (const std::int32_t slot : slots_) {
        facet_[index(slot)] = kNobody;
    }
    edges_.clear();
    sides_.clear();
    facets_.clear();
    slots_.clear();
    sliding_.clear();
    locals_.clear();
    sands_.clear();
    heights_.clear();
    inflow_.clear();
    flowed_.clear();
    return result;
}

std::vector<Vertex> ActiveEdges::takeHeldBack() { return std::exchange(heldBack_, {}); }

}  // namespace sand::tin
