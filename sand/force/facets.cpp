// SPDX-License-Identifier: Apache-2.0
#include "sand/force/facets.hpp"

#include <algorithm>
#include <cmath>

namespace sand::force {
namespace {

constexpr double kParts = 256;  // of a probe unit, to which a place is rounded

std::size_t at(std::int32_t number) { return static_cast<std::size_t>(number); }

/// Whether a triangle owns the places on its edge from a to b; the one beyond runs the other way round, and does not.
bool owns(double acrossX, double acrossY) { return acrossY < 0 || (acrossY == 0 && acrossX > 0); }

/// Whether a triangle and a square have a place in common: exactly, for a walk could end in one that only nearly does.
bool overlap(const std::array<tin::Place, 3>& corner, const std::array<std::int32_t, 4>& square) {
    const auto& [a, b, c] = corner;
    const auto [west, south, east, north] = square;
    if (std::min({a.x, b.x, c.x}) > east || std::max({a.x, b.x, c.x}) < west || std::min({a.y, b.y, c.y}) > north ||
        std::max({a.y, b.y, c.y}) < south) {
        return false;
    }
    if (a.x >= west && a.x <= east && a.y >= south && a.y <= north) {
        return true;  // as nearly all
    }
    const std::array<tin::Place, 4> ends{{{west, south}, {east, south}, {east, north}, {west, north}}};
    for (std::size_t k = 0; k < 3; ++k) {
        if (std::ranges::all_of(
                ends, [&](const tin::Place& end) { return doubledArea(corner[k], corner[(k + 1) % 3], end) < 0; })) {
            return false;
        }
    }
    return true;
}

}  // namespace

void Facets::Index::clear() {
    std::fill(places_.begin(), places_.end(), std::pair{-1, -1});
    count_ = 0;
}

std::size_t Facets::Index::placeOf(std::int32_t slot) const {
    const std::size_t last = places_.size() - 1;  // their count is a power of two
    std::size_t place = static_cast<std::uint32_t>(slot) * 0x9e3779b1U >> 8U & last;
    while (places_[place].first != -1 && places_[place].first != slot) {
        place = (place + 1) & last;
    }
    return place;
}

std::int32_t Facets::Index::put(std::int32_t slot, std::int32_t number) {
    if (2 * count_ >= places_.size()) {
        std::vector<std::pair<std::int32_t, std::int32_t>> before(std::max<std::size_t>(256, 2 * places_.size()),
                                                                  {-1, -1});
        before.swap(places_);
        for (const auto& entry : before) {
            if (entry.first != -1) {
                places_[placeOf(entry.first)] = entry;
            }
        }
    }
    auto& entry = places_[placeOf(slot)];
    if (entry.first == -1) {
        entry = {slot, number};
        ++count_;
    }
    return entry.second;
}

std::int32_t Facets::Index::find(std::int32_t slot) const { return places_[placeOf(slot)].second; }

bool Facets::take(const tin::SurfaceView& tin, const ProbePoint& centre, std::int32_t reach, double unit) {
    const tin::Triangles& mesh = tin.triangles;
    const tin::Place middle{std::clamp(centre.x, 0, mesh.width), std::clamp(centre.y, 0, mesh.depth)};
    square_ = {std::max(middle.x - reach, 0), std::max(middle.y - reach, 0), std::min(middle.x + reach, mesh.width),
               std::min(middle.y + reach, mesh.depth)};
    facets_.clear();
    last_ = 0;
    if (!findSlots(mesh, middle)) {
        return false;
    }
    unit_ = unit;
    middleX_ = middle.x;
    middleY_ = middle.y;
    // On the rim itself the triangle that owns a place could be one beyond it.
    west_ = std::max<double>(square_[0], 1 / kParts) - middle.x;
    south_ = std::max<double>(square_[1], 1 / kParts) - middle.y;
    east_ = std::min<double>(square_[2], mesh.width - 1 / kParts) - middle.x;
    north_ = std::min<double>(square_[3], mesh.depth - 1 / kParts) - middle.y;
    for (const std::int32_t slot : slots_) {
        facets_.push_back(facetOf(tin, slot, middle));
    }
    levelHoles(tin);
    return true;
}

void Facets::levelHoles(const tin::SurfaceView& tin) {
    const auto isHole = [&](std::int32_t slot) { return tin.triangles.triangles[at(slot)].hole; };
    if (std::ranges::none_of(slots_, isHole) || std::ranges::all_of(slots_, isHole)) {
        return;
    }
    double lowest = kMaxHeight;  // [unit]
    for (const std::int32_t slot : slots_) {
        for (std::size_t k = 0; k < 3 && !isHole(slot); ++k) {
            lowest = std::min(lowest, tin.heights[at(tin.triangles.triangles[at(slot)].corner[k])]);
        }
    }
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        if (isHole(slots_[i])) {
            facets_[i].height = lowest * unit_ * kProbePerCell / kUnitsPerCell;
            facets_[i].east = facets_[i].north = 0;
        }
    }
}

/// The square is convex: triangles that reach into it hang together by their edges, and so does the search.
bool Facets::findSlots(const tin::Triangles& mesh, const tin::Place& middle) {
    const auto reaches = [&](std::int32_t slot) {
        const auto& corner = mesh.triangles[at(slot)].corner;
        return overlap({mesh.places[at(corner[0])], mesh.places[at(corner[1])], mesh.places[at(corner[2])]}, square_);
    };
    const auto take = [&](std::int32_t slot) {
        const auto next = static_cast<std::int32_t>(slots_.size());
        if (reaches(slot) && index_.put(slot, next) == next) {
            slots_.push_back(slot);
        }
    };
    index_.clear();
    slots_.clear();
    take(locate(mesh, middle, tin::kNobody).triangle);
    for (std::size_t i = 0; i < slots_.size() && slots_.size() <= kMost; ++i) {
        for (const std::int32_t beyond : mesh.triangles[at(slots_[i])].neighbour) {
            if (beyond != tin::kNobody) {
                take(beyond);
            }
        }
    }
    return slots_.size() <= kMost;
}

Facets::Facet Facets::facetOf(const tin::SurfaceView& tin, std::int32_t slot, const tin::Place& middle) const {
    const tin::Triangle& triangle = tin.triangles.triangles[at(slot)];
    Facet facet{};
    std::array<double, 3> height{};
    const double unit = unit_ * kProbePerCell / kUnitsPerCell;  // [scene unit], of a height
    // From the smallest vertex on, for where a mesh begins its corners is no matter, and must not show in a rounding.
    const auto first = static_cast<std::size_t>(std::ranges::min_element(triangle.corner) - triangle.corner.begin());
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t from = (first + k) % 3;
        const tin::Place place = tin.triangles.places[at(triangle.corner[from])];
        facet.x[k] = static_cast<float>(place.x - middle.x);
        facet.y[k] = static_cast<float>(place.y - middle.y);
        facet.beyond[k] = triangle.neighbour[from] == tin::kNobody ? -1 : index_.find(triangle.neighbour[from]);
        height[k] = tin.heights[at(triangle.corner[from])] * unit;
    }
    const double bx = facet.x[1] - facet.x[0], by = facet.y[1] - facet.y[0];
    const double cx = facet.x[2] - facet.x[0], cy = facet.y[2] - facet.y[0];
    const double doubledArea = bx * cy - by * cx;
    facet.height = height[0];
    facet.east = ((height[1] - height[0]) * cy - (height[2] - height[0]) * by) / doubledArea;
    facet.north = ((height[2] - height[0]) * bx - (height[1] - height[0]) * cx) / doubledArea;
    return facet;
}

/// From the facet found last, always beyond some edge that the place lies beyond. Which one is left to chance, for
/// walks of one rule can go round constraints for ever; where they end does not depend on it. An edge of the walk that
/// leads out of the square has another beside it that does not.
const Facets::Facet& Facets::find(double x, double y) const {
    std::uint32_t chance = 1;
    std::int32_t slot = last_, before = -1;
    for (std::size_t steps = 4 * facets_.size();; --steps) {
        const Facet& facet = facets_[at(slot)];
        chance = chance * 1664525U + 1013904223U;
        std::size_t side = (chance >> 16U) % 3;
        std::int32_t next = -1;
        for (int tried = 0; tried < 3 && next < 0; ++tried, side = side == 2 ? 0 : side + 1) {
            if (facet.beyond[side] < 0 || facet.beyond[side] == before) {
                continue;  // nobody is there, or the walk came from there
            }
            const std::size_t a = side == 2 ? 0 : side + 1, b = a == 2 ? 0 : a + 1;
            const double dx = double{facet.x[b]} - facet.x[a], dy = double{facet.y[b]} - facet.y[a];
            const double inside = dx * (y - facet.y[a]) - dy * (x - facet.x[a]);
            if (inside < 0 || (inside == 0 && !owns(dx, dy))) {
                next = facet.beyond[side];
            }
        }
        if (next < 0 || steps == 0) {
            last_ = slot;
            return facet;
        }
        before = slot;
        slot = next;
    }
}

Dual Facets::tangent(double x, double y) const {
    const double freeX = x / unit_ - middleX_, freeY = y / unit_ - middleY_;
    const double fromX = std::clamp(freeX, west_, east_), fromY = std::clamp(freeY, south_, north_);
    const double roundX = std::floor(fromX * kParts + 0.5) / kParts, roundY = std::floor(fromY * kParts + 0.5) / kParts;
    const Facet& facet = find(roundX, roundY);
    return {facet.height + facet.east * (roundX - facet.x[0]) + facet.north * (roundY - facet.y[0]),
            {fromX == freeX ? facet.east / unit_ : 0, fromY == freeY ? facet.north / unit_ : 0, 0}};
}

}  // namespace sand::force
