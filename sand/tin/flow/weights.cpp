// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/flow/weights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sand/tin/flow/sweep_kernel.hpp"

namespace sand::tin {
namespace {

constexpr double kOne = 1048576;  // 1 as an integer weight: 2^20
// Limit for half a cotangent. A sliver's has no bound, and all edges of a vertex would wait for one edge.
constexpr double kMostWeight = 4;
constexpr double kSafe = 0.9996;  // share of the bound that is used; the rest is room for roundings
constexpr double kGrain = 0.5;    // accuracy of a height [unit]

const Triangle& triangleOf(const Triangles& mesh, std::int32_t slot) {
    return mesh.triangles[static_cast<std::size_t>(slot)];
}
const LatticePoint& placeOf(const Triangles& mesh, Vertex vertex) {
    return mesh.places[static_cast<std::size_t>(vertex)];
}

std::int64_t dot(const LatticePoint& origin, const LatticePoint& a, const LatticePoint& b) {
    return std::int64_t{a.x - origin.x} * (b.x - origin.x) + std::int64_t{a.y - origin.y} * (b.y - origin.y);
}

/// The corner opposite a side, and the side's two ends counter-clockwise.
struct Corners {
    Vertex apex, begin, end;
};

Corners cornersOf(const Triangles& mesh, TriangleSide side) {
    const auto& corner = triangleOf(mesh, side.triangle).corner;
    const auto k = static_cast<std::size_t>(side.corner);
    return {corner[k], corner[(k + 1) % 3], corner[(k + 2) % 3]};
}

/// Returns half the cotangent of the angle at `apex`.
double half(const LatticePoint& apex, const LatticePoint& begin, const LatticePoint& end, double doubledArea) {
    // Both are integers below 2^53, so that the quotient is rounded once.
    return 0.5 * static_cast<double>(dot(apex, begin, end)) / doubledArea;
}

}  // namespace

TriangleSide across(const Triangles& mesh, TriangleSide side) {
    const std::int32_t beyond = triangleOf(mesh, side.triangle).neighbour[static_cast<std::size_t>(side.corner)];
    if (beyond == kNoNumber || triangleOf(mesh, beyond).hole) {
        return {};
    }
    const auto& back = triangleOf(mesh, beyond).neighbour;
    return {beyond, back[0] == side.triangle ? 0 : back[1] == side.triangle ? 1 : 2};
}

void Weights::forget(const Mesh::Change& change) {
    for (const std::int32_t slot : change.triangles) {
        if (static_cast<std::size_t>(slot) < halves_.size()) {
            halves_[static_cast<std::size_t>(slot)].first = kNoNumber;
        }
    }
    for (const Vertex vertex : change.vertices) {
        if (static_cast<std::size_t>(vertex) < steps_.size()) {
            steps_[static_cast<std::size_t>(vertex)] = 0;
        }
    }
}

void Weights::reserve(std::size_t vertices) {
    steps_.resize(std::max(steps_.size(), vertices), 0);
    halves_.resize(std::max(halves_.size(), 2 * vertices));
}

const std::array<std::int32_t, 3>& Weights::halvesOf(const Triangles& mesh, std::int32_t slot) {
    if (static_cast<std::size_t>(slot) >= halves_.size()) {
        halves_.resize(mesh.triangles.size() + mesh.triangles.size() / 4);
    }
    const auto& corner = triangleOf(mesh, slot).corner;
    Halves& halves = halves_[static_cast<std::size_t>(slot)];
    if (halves.first != corner[0]) {
        const LatticePoint &a = placeOf(mesh, corner[0]), &b = placeOf(mesh, corner[1]), &c = placeOf(mesh, corner[2]);
        const auto area = static_cast<double>(doubledArea(a, b, c));
        const std::array<double, 3> of{half(a, b, c, area), half(b, c, a, area), half(c, a, b, area)};
        // All three get one factor. If each were cut by itself, a sliver's sand would not run down the sliver's slope.
        const double scale = kOne * std::min(kMostWeight / std::max({of[0], of[1], of[2], kMostWeight}), 1.0);
        halves.first = corner[0];
        std::transform(of.begin(), of.end(), halves.of.begin(),
                       [&](double half) { return static_cast<std::int32_t>(half * scale); });
    }
    return halves.of;
}

double Weights::step(const Triangles& mesh, std::span<const std::int64_t> stars, Vertex vertex) {
    const auto v = static_cast<std::size_t>(vertex);
    if (v >= steps_.size()) {
        steps_.resize(mesh.places.size() + mesh.places.size() / 4);
    }
    if (steps_[v] == 0) {
        std::int64_t sum = 0;
        aroundVertex(mesh, vertex, [&](std::int32_t slot, int corner) {
            if (triangleOf(mesh, slot).hole) {
                return;
            }
            const auto& halves = halvesOf(mesh, slot);
            for (const int end : {1, 2}) {
                sum += std::max(halves[static_cast<std::size_t>((corner + end) % 3)], 0);
            }
        });
        // One of a triangle's two angles beside this vertex is acute. It may be so close to a right angle that its
        // integer weight is 0.
        sum = std::max<std::int64_t>(sum, 1);
        steps_[v] = kSafe * static_cast<double>(stars[v]) / static_cast<double>(sum);
    }
    return steps_[v];
}

Edge Weights::edge(const Triangles& mesh, std::span<const std::int64_t> stars, TriangleSide side, TriangleSide across) {
    const Corners c = cornersOf(mesh, side);
    Edge edge{.from = std::min(c.begin, c.end),
              .to = std::max(c.begin, c.end),
              .leftFacet = side.triangle,
              .rightFacet = side.triangle};
    const auto weight = [&](TriangleSide one) {
        const auto& corner = triangleOf(mesh, one.triangle).corner;
        const auto stepAt = [&](std::size_t k) { return step(mesh, stars, corner[k]); };
        return static_cast<double>(halvesOf(mesh, one.triangle)[static_cast<std::size_t>(one.corner)]) *
               std::min({stepAt(0), stepAt(1), stepAt(2)});
    };
    edge.left = weight(side);
    if (across.triangle != kNoNumber) {
        edge.rightFacet = across.triangle;
        edge.right = weight(across);
    }
    return edge;
}

double slackOf(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c) {
    const auto length = [](const LatticePoint& from, const LatticePoint& to) {
        return std::sqrt(static_cast<double>(dot(from, to, to)));
    };
    // A corner that is higher by 1 changes the slope by the length of the opposite side over the doubled area.
    return kGrain * (length(a, b) + length(a, c) + length(b, c)) / static_cast<double>(doubledArea(a, b, c));
}

std::array<Vertex, 3> smallestFirst(const std::array<Vertex, 3>& corner) {
    const auto least = static_cast<std::size_t>(leastOf(corner));
    return {corner[least], corner[(least + 1) % 3], corner[(least + 2) % 3]};
}

Facet facetOf(const Triangles& mesh, std::int32_t slot, const Slopes& slopes) {
    Facet facet;
    facet.corner = smallestFirst(triangleOf(mesh, slot).corner);
    const LatticePoint& origin = placeOf(mesh, facet.corner[0]);
    const LatticePoint& first = placeOf(mesh, facet.corner[1]);
    const LatticePoint& second = placeOf(mesh, facet.corner[2]);
    const auto area = static_cast<double>(doubledArea(origin, first, second));
    const auto firstSquared = static_cast<double>(dot(origin, first, first));
    const auto secondSquared = static_cast<double>(dot(origin, second, second));
    const auto product = static_cast<double>(dot(origin, first, second));
    const double slack = slackOf(origin, first, second);
    const double scale = area * (slopes.slide + slack);
    facet.first = secondSquared / scale / scale;
    facet.mixed = -2 * product / scale / scale;
    facet.second = firstSquared / scale / scale;
    const double start = (slopes.start + slack) / (slopes.slide + slack);
    // Not below kRest, however narrow the band is. Otherwise sand at rest would start again once its flow is
    // forgotten. The time of forgetting must not change a result.
    facet.start = std::max(start * start, kRest);
    return facet;
}

}  // namespace sand::tin
