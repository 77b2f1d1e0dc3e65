// SPDX-License-Identifier: Apache-2.0
// Part of DualProjection: selects the triangles that it computes, and prepares them.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sand/tin/flow/dual_projection.hpp"
#include "sand/tin/flow/weights.hpp"

namespace sand::tin {

DualProjection::DualProjection(const VertexSand& layer, double slope, Rim rim)
    : layer_(layer), slope_(slope), rim_(rim) {
    const std::vector<Vertex> steep = steepCorners();
    if (!steep.empty()) {
        surround(steep);
    }
}

std::vector<Vertex> DualProjection::steepCorners() const {
    const Triangles& mesh = layer_.triangles();
    std::vector<Vertex> corners;
    for (std::size_t slot = 0; slot < mesh.triangles.size(); ++slot) {
        if (mesh.triangles[slot].isGround()) {
            const Facet facet = facetOf(static_cast<std::int32_t>(slot), {});
            const Vector slope = facet.slope(layer_.heights());
            if (std::sqrt(slope.times(slope)) > facet.most) {
                corners.insert(corners.end(), facet.corner.begin(), facet.corner.end());
            }
        }
    }
    return corners;
}

std::vector<Vertex> DualProjection::pressedCorners() const {
    std::vector<Vertex> corners;
    for (std::size_t i = 0; i < facets_.size(); ++i) {
        if (pressures_[i].any()) {
            const auto& corner = layer_.triangles().triangles[index(slots_[i])].corner;
            corners.insert(corners.end(), corner.begin(), corner.end());
        }
    }
    return corners;
}

bool DualProjection::nearEdge() const {
    const std::vector<Vertex> corners = pressedCorners();
    return std::any_of(corners.begin(), corners.end(), [this](Vertex corner) {
        const int edges = edges_[index(corner)];
        return edges >= kFar - kMargin;
    });
}

DualProjection::Facet DualProjection::facetOf(std::int32_t slot, const std::vector<std::int32_t>& local) const {
    const Triangles& mesh = layer_.triangles();
    const std::array<Vertex, 3> corner = smallestFirst(mesh.triangles[index(slot)].corner);
    const LatticePoint &a = mesh.places[index(corner[0])], &b = mesh.places[index(corner[1])],
                       &c = mesh.places[index(corner[2])];
    const auto area = static_cast<double>(doubledArea(a, b, c));
    Facet facet;
    std::transform(corner.begin(), corner.end(), facet.corner.begin(),
                   [&](Vertex vertex) { return local.empty() ? vertex : local[index(vertex)]; });
    facet.first = {(c.y - a.y) / area, (a.x - c.x) / area};
    facet.second = {(a.y - b.y) / area, (b.x - a.x) / area};
    facet.most = (1 - kTalusSlack) * slope_ + slackOf(a, b, c);
    return facet;
}

std::vector<std::int32_t> DualProjection::trianglesWithin() const {
    const Triangles& mesh = layer_.triangles();
    std::vector<std::pair<std::array<Vertex, 3>, std::int32_t>> found;
    for (std::size_t slot = 0; slot < mesh.triangles.size(); ++slot) {
        const Triangle& triangle = mesh.triangles[slot];
        if (triangle.isGround() && std::all_of(triangle.corner.begin(), triangle.corner.end(),
                                               [this](Vertex corner) { return edges_[index(corner)] < kFar; })) {
            found.emplace_back(smallestFirst(triangle.corner), static_cast<std::int32_t>(slot));
        }
    }
    std::sort(found.begin(), found.end());
    std::vector<std::int32_t> slots(found.size());
    std::transform(found.begin(), found.end(), slots.begin(), [](const auto& one) { return one.second; });
    return slots;
}

void DualProjection::countEdges(const std::vector<Vertex>& corners) {
    const Triangles& mesh = layer_.triangles();
    edges_.assign(mesh.places.size(), kFar);
    std::vector<Vertex> reached, next;
    const auto reach = [&](Vertex vertex, int edges) {
        if (edges_[index(vertex)] == kFar) {
            edges_[index(vertex)] = static_cast<std::uint8_t>(edges);
            next.push_back(vertex);
        }
    };
    std::for_each(corners.begin(), corners.end(), [&](Vertex corner) { reach(corner, 0); });
    for (int edges = 1; edges <= kReach; ++edges) {
        reached.swap(next);
        next.clear();
        for (const Vertex vertex : reached) {
            aroundVertex(mesh, vertex, [&](std::int32_t slot, int) {
                const Triangle& triangle = mesh.triangles[index(slot)];
                if (triangle.isGround()) {
                    std::for_each(triangle.corner.begin(), triangle.corner.end(),
                                  [&](Vertex corner) { reach(corner, edges); });
                }
            });
        }
    }
}

void DualProjection::surround(const std::vector<Vertex>& corners) {
    const Triangles& mesh = layer_.triangles();
    std::vector<Pressure> pressures(mesh.triangles.size());
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        pressures[index(slots_[i])] = pressures_[i];
    }
    countEdges(corners);
    std::vector<double> fallen(spills_.empty() ? 0 : 2 * mesh.places.size());
    for (const Spill& spill : spills_) {
        const std::size_t vertex = index(vertices_[index(spill.vertex)]);
        fallen[2 * vertex] = spill.now;
        fallen[2 * vertex + 1] = spill.before;
    }
    std::vector<std::int32_t> local(mesh.places.size(), kNoNumber);
    vertices_.clear();
    for (std::size_t vertex = 0; vertex < local.size(); ++vertex) {
        if (edges_[vertex] < kFar) {
            local[vertex] = static_cast<std::int32_t>(vertices_.size());
            vertices_.push_back(static_cast<Vertex>(vertex));
        }
    }
    slots_ = trianglesWithin();
    facets_.clear();
    pressures_.clear();
    for (const std::int32_t slot : slots_) {
        facets_.push_back(facetOf(slot, local));
        pressures_.push_back(pressures[index(slot)]);
    }
    stars_.clear();
    start_.clear();
    for (const Vertex vertex : vertices_) {
        stars_.push_back(static_cast<double>(layer_.stars()[index(vertex)]));
        start_.push_back(layer_.heights()[index(vertex)]);
    }
    taken_.assign(vertices_.size(), 0);
    heights_ = start_;
    findSpills(fallen);
    makeSteps();
}

/// Finds the vertices on an open rim. `fallen` has two numbers per vertex of the layer, its spill's `now` and `before`
/// until now. It may be empty.
void DualProjection::findSpills(const std::vector<double>& fallen) {
    spills_.clear();
    for (std::size_t i = 0; rim_ == Rim::open && i < vertices_.size(); ++i) {
        const std::size_t vertex = index(vertices_[i]);
        if (isOnRim(layer_.triangles(), layer_.triangles().places[vertex]) && layer_.stars()[vertex] > 0) {
            spills_.push_back({.vertex = static_cast<std::int32_t>(i),
                               .now = fallen.empty() ? 0 : fallen[2 * vertex],
                               .before = fallen.empty() ? 0 : fallen[2 * vertex + 1]});
        }
    }
}

void DualProjection::makeSteps() {
    // A vertex at the edge of the computed area lacks some of its triangles. Its computed triangles are not under
    // pressure.
    std::vector<double> around(vertices_.size(), 0);
    std::vector<double> weights(facets_.size());
    for (std::size_t i = 0; i < facets_.size(); ++i) {
        Facet& facet = facets_[i];
        const Vector &first = facet.first, &second = facet.second;
        const double perArea = first.east * second.north - first.north * second.east;
        // GᵀG has two eigenvalues other than 0. `half` is half their sum. Their product is 3 perArea², where perArea
        // is 1 / (doubled area).
        const double half = first.times(first) + second.times(second) + first.times(second);
        const double largest = half + std::sqrt(std::max(half * half - 3 * perArea * perArea, 0.0));
        weights[i] = std::sqrt(largest) / perArea;
        facet.step = 1 / largest;
        for (const std::int32_t corner : facet.corner) {
            around[index(corner)] += weights[i];
        }
    }
    for (Spill& spill : spills_) {
        spill.step = 0.5 * stars_[index(spill.vertex)];
        around[index(spill.vertex)] *= 2;
    }
    for (std::size_t i = 0; i < facets_.size(); ++i) {
        double share = std::numeric_limits<double>::max();
        for (const std::int32_t corner : facets_[i].corner) {
            share = std::min(share, stars_[index(corner)] * weights[i] / around[index(corner)]);
        }
        facets_[i].step *= share;
    }
}

}  // namespace sand::tin
