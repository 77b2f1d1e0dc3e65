// SPDX-License-Identifier: Apache-2.0
#include "scene/relax/slivers.hpp"

#include <algorithm>
#include <cmath>

namespace scene::relax {
namespace {

using sand::tin::index;
using sand::tin::kNoNumber;
using sand::tin::LatticePoint;
using sand::tin::Triangle;
using sand::tin::Triangles;

constexpr double kLeastHeight = 1.0 / 64;  // [lattice step], least height of a triangle over its longest edge

std::int64_t squaredLength(const LatticePoint& a, const LatticePoint& b) {
    const std::int64_t x = std::int64_t{b.x} - a.x, y = std::int64_t{b.y} - a.y;
    return x * x + y * y;
}

class RimPeeler {
public:
    explicit RimPeeler(const Triangles& mesh)
        : mesh_(mesh),
          nearRim_(std::min(kNearRim, std::min(mesh.width, mesh.depth) / kStripsAcross)),
          isOutside_(mesh.triangles.size()),
          isOnBoundary_(mesh.places.size()) {
        std::transform(mesh.places.begin(), mesh.places.end(), isOnBoundary_.begin(),
                       [&mesh](const LatticePoint& place) { return isOnRim(mesh, place); });
    }

    std::vector<std::int32_t> peel() {
        for (std::size_t slot = 0; slot < mesh_.triangles.size(); ++slot) {
            look(static_cast<std::int32_t>(slot));
        }
        // Triangles beyond a taken one are now at the boundary. The list grows during the loop.
        for (std::size_t next = 0; next < taken_.size(); ++next) {
            for (const std::int32_t beyond : mesh_.triangles[index(taken_[next])].neighbour) {
                if (beyond != kNoNumber) {
                    look(beyond);
                }
            }
        }
        return std::move(taken_);
    }

private:
    [[nodiscard]] LatticePoint placeOf(const Triangle& triangle, std::size_t corner) const {
        return mesh_.places[index(triangle.corner.at(corner % 3))];
    }
    [[nodiscard]] bool looksOutwards(const Triangle& triangle, std::size_t side) const {
        const std::int32_t beyond = triangle.neighbour.at(side % 3);
        return beyond == kNoNumber || isOutside_[index(beyond)];
    }

    /// Takes a triangle at the boundary if it is a sliver.
    void look(std::int32_t slot) {
        const Triangle& triangle = mesh_.triangles[index(slot)];
        for (std::size_t side = 0; side < 3 && triangle.isGround() && !isOutside_[index(slot)]; ++side) {
            const auto apex = index(triangle.corner.at(side));
            // Ground whose parts are connected only by a vertex would not be a surface.
            const bool parts =
                isOnBoundary_[apex] && !looksOutwards(triangle, side + 1) && !looksOutwards(triangle, side + 2);
            if (looksOutwards(triangle, side) && !parts && isSliver(triangle, side)) {
                isOutside_[index(slot)] = true;
                isOnBoundary_[apex] = true;
                taken_.push_back(slot);
            }
        }
    }

    [[nodiscard]] bool isSliver(const Triangle& triangle, std::size_t side) const {
        const LatticePoint apex = placeOf(triangle, side);
        const LatticePoint from = placeOf(triangle, side + 1), to = placeOf(triangle, side + 2);
        const std::int64_t squared = squaredLength(from, to);
        const bool isLongest = squared >= squaredLength(apex, from) && squared >= squaredLength(apex, to);
        return isLongest && kFlat * doubledArea(apex, from, to) < squared && isNearOneSide({apex, from, to});
    }

    [[nodiscard]] bool isNearOneSide(const std::array<LatticePoint, 3>& places) const {
        const auto all = [&places](const auto& isNear) { return std::all_of(places.begin(), places.end(), isNear); };
        return all([this](const LatticePoint& place) { return place.y <= nearRim_; }) ||
               all([this](const LatticePoint& place) { return place.x <= nearRim_; }) ||
               all([this](const LatticePoint& place) { return place.y >= mesh_.depth - nearRim_; }) ||
               all([this](const LatticePoint& place) { return place.x >= mesh_.width - nearRim_; });
    }

    const Triangles& mesh_;
    std::int32_t nearRim_;
    std::vector<bool> isOutside_;     // one per slot
    std::vector<bool> isOnBoundary_;  // one per vertex
    std::vector<std::int32_t> taken_;
};

}  // namespace

std::vector<std::int32_t> sliversAtRim(const Triangles& mesh) { return RimPeeler(mesh).peel(); }

int keepCounterClockwise(const Triangles& mesh, const ExactLattice& lattice,
                         std::vector<std::array<double, 3>>& points) {
    std::vector<bool> isOnLattice(points.size());
    int moved = 0;
    const auto isSound = [&](const Triangle& triangle) {
        const auto& [a, b, c] = triangle.corner;
        if (isOnLattice[index(a)] && isOnLattice[index(b)] && isOnLattice[index(c)]) {
            return true;  // the mesh guarantees it
        }
        const auto &p = points[index(a)], &q = points[index(b)], &r = points[index(c)];
        const double area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        const double longest = std::max({std::hypot(q[0] - p[0], q[1] - p[1]), std::hypot(r[0] - p[0], r[1] - p[1]),
                                         std::hypot(r[0] - q[0], r[1] - q[1])});
        return area > kLeastHeight * lattice.step * longest;
    };
    for (bool all = false; !all;) {
        all = true;
        for (const Triangle& triangle : mesh.triangles) {
            if (!triangle.isGround() || isSound(triangle)) {
                continue;
            }
            all = false;
            for (const sand::tin::Vertex corner : triangle.corner) {
                if (!isOnLattice[index(corner)]) {
                    isOnLattice[index(corner)] = true;
                    auto& [pointX, pointY, height] = points[index(corner)];
                    const auto [x, y] = lattice.at(mesh.places[index(corner)]);
                    moved += pointX != x || pointY != y ? 1 : 0;
                    pointX = x;
                    pointY = y;
                }
            }
        }
    }
    return moved;
}

}  // namespace scene::relax
