// SPDX-License-Identifier: Apache-2.0
#include "sand/force/facets.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sand::force {
namespace {

constexpr std::int64_t kParts = 256;  // parts per probe unit; places are rounded to a part

std::size_t at(std::int32_t number) { return static_cast<std::size_t>(number); }

/// Returns the whole number nearest to `value`, halves up. This equals floor(value + 0.5), which would call a library.
std::int64_t nearest(double value) {
    const double raised = value + 0.5;
    const auto cut = static_cast<std::int64_t>(raised);
    return cut - (static_cast<double>(cut) > raised ? 1 : 0);
}

/// Returns whether a triangle owns the places on its edge from a to b. In the triangle beyond, the edge runs the other
/// way round, so that only one of them owns it.
bool owns(std::int64_t acrossX, std::int64_t acrossY) { return acrossY < 0 || (acrossY == 0 && acrossX > 0); }

/// Returns whether a triangle and a square have a place in common. The test is exact, because otherwise a walk could
/// end in a triangle that only nearly reaches into the square.
bool overlap(const std::array<tin::LatticePoint, 3>& corner, const std::array<std::int32_t, 4>& square) {
    const auto& [a, b, c] = corner;
    const auto [west, south, east, north] = square;
    if (std::min({a.x, b.x, c.x}) > east || std::max({a.x, b.x, c.x}) < west || std::min({a.y, b.y, c.y}) > north ||
        std::max({a.y, b.y, c.y}) < south) {
        return false;
    }
    if (a.x >= west && a.x <= east && a.y >= south && a.y <= north) {
        return true;  // true for nearly all triangles
    }
    const std::array<tin::LatticePoint, 4> ends{{{west, south}, {east, south}, {east, north}, {west, north}}};
    for (std::size_t k = 0; k < 3; ++k) {
        if (std::all_of(ends.begin(), ends.end(), [&](const tin::LatticePoint& end) {
                return doubledArea(corner[k], corner[(k + 1) % 3], end) < 0;
            })) {
            return false;
        }
    }
    return true;
}

}  // namespace

/// Has no branch, because the processor cannot predict on which side a place is.
std::array<std::int64_t, 3> Facets::Facet::within(const Spot& spot) const {
    std::array<std::int64_t, 3> result{};
    for (std::size_t side = 0; side < 3; ++side) {
        result[side] = towardsX[side] * spot.x + towardsY[side] * spot.y + atMiddle[side];
    }
    return result;
}

void Facets::Index::clear() {
    std::fill(places_.begin(), places_.end(), std::pair{-1, -1});
    count_ = 0;
}

std::size_t Facets::Index::placeOf(std::int32_t slot) const {
    const std::size_t last = places_.size() - 1;  // the size of `places_` is a power of two
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

bool Facets::take(const tin::SurfaceView& tin, const ProbePoint& probe, std::int32_t reach, double unit) {
    const tin::Triangles& mesh = tin.triangles;
    const tin::LatticePoint middle{std::clamp(probe.x, 0, mesh.width), std::clamp(probe.y, 0, mesh.depth)};
    square_ = {std::max(middle.x - reach, 0), std::max(middle.y - reach, 0), std::min(middle.x + reach, mesh.width),
               std::min(middle.y + reach, mesh.depth)};
    clear();
    if (!findSlots(mesh, middle)) {
        return false;
    }
    unit_ = unit;
    partsPerSceneUnit_ = kParts / unit;
    middleX_ = static_cast<double>(kParts * middle.x);
    middleY_ = static_cast<double>(kParts * middle.y);
    // On the rim itself, the triangle that owns a place could be outside the field.
    const auto inField = [](std::int32_t side, std::int32_t end, std::int32_t from) {
        return static_cast<double>(std::clamp<std::int64_t>(kParts * side, 1, kParts * end - 1) - kParts * from);
    };
    west_ = inField(square_[0], mesh.width, middle.x);
    south_ = inField(square_[1], mesh.depth, middle.y);
    east_ = inField(square_[2], mesh.width, middle.x);
    north_ = inField(square_[3], mesh.depth, middle.y);
    for (const std::int32_t slot : slots_) {
        add(tin, slot, middle);
    }
    levelHoles(tin);
    findStarts();
    return true;
}

/// Walks to and fro over the square, because the way from one field's middle to the next is then short. There are half
/// as many fields as facets. With four times as many, a query takes a tenth less time and a copy a fifth more.
void Facets::findStarts() {
    const double side = std::ceil(std::sqrt(static_cast<double>(facets_.size()) / 2));
    startsPerSide_ = std::min<std::size_t>(static_cast<std::size_t>(side), kMostStarts);
    columnsPer_ = static_cast<double>(startsPerSide_) / (east_ - west_);
    rowsPer_ = static_cast<double>(startsPerSide_) / (north_ - south_);
    std::int32_t last = 0;
    for (std::size_t row = 0; row < startsPerSide_; ++row) {
        for (std::size_t i = 0; i < startsPerSide_; ++i) {
            const std::size_t column = row % 2 == 0 ? i : startsPerSide_ - 1 - i;
            const double x = west_ + (static_cast<double>(column) + 0.5) / columnsPer_;
            const double y = south_ + (static_cast<double>(row) + 0.5) / rowsPer_;
            last = find({nearest(x), nearest(y)}, last);
            starts_[row * startsPerSide_ + column] = static_cast<std::int16_t>(last);
        }
    }
}

std::size_t Facets::startOf(double x, double y) const {
    const auto field = [this](double from) {
        return std::min(static_cast<std::size_t>(static_cast<std::int64_t>(from)), startsPerSide_ - 1);
    };
    return field((y - south_) * rowsPer_) * startsPerSide_ + field((x - west_) * columnsPer_);
}

void Facets::levelHoles(const tin::SurfaceView& tin) {
    const auto isHole = [&](std::int32_t slot) { return tin.triangles.triangles[at(slot)].hole; };
    if (std::none_of(slots_.begin(), slots_.end(), isHole) || std::all_of(slots_.begin(), slots_.end(), isHole)) {
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
            planes_[i] = {lowest * unit_ * kProbePerCell / kUnitsPerCell, 0, 0};
        }
    }
}

/// Searches from triangle to triangle across edges. The square is convex, so that all triangles that reach into it are
/// connected by edges.
bool Facets::findSlots(const tin::Triangles& mesh, const tin::LatticePoint& middle) {
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
    take(locate(mesh, middle, tin::kNoNumber).triangle);
    for (std::size_t i = 0; i < slots_.size() && slots_.size() <= kMost; ++i) {
        for (const std::int32_t beyond : mesh.triangles[at(slots_[i])].neighbour) {
            if (beyond != tin::kNoNumber) {
                take(beyond);
            }
        }
    }
    return slots_.size() <= kMost;
}

void Facets::add(const tin::SurfaceView& tin, std::int32_t slot, const tin::LatticePoint& middle) {
    const tin::Triangle& triangle = tin.triangles.triangles[at(slot)];
    // Begins with the smallest vertex, so that the order of the corners in the mesh does not affect rounding.
    const auto first = static_cast<std::size_t>(std::min_element(triangle.corner.begin(), triangle.corner.end()) -
                                                triangle.corner.begin());
    std::array<std::int64_t, 3> x{}, y{};  // from the middle of the square [part]
    std::array<double, 3> height{};
    Facet facet{};
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t from = (first + k) % 3;
        const tin::LatticePoint place = tin.triangles.places[at(triangle.corner[from])];
        x[k] = kParts * (place.x - middle.x);
        y[k] = kParts * (place.y - middle.y);
        height[k] = tin.heights[at(triangle.corner[from])] * unit_ * kProbePerCell / kUnitsPerCell;
        const std::int32_t beyond =
            triangle.neighbour[from] == tin::kNoNumber ? -1 : index_.find(triangle.neighbour[from]);
        facet.beyond[k] = static_cast<std::int16_t>(beyond);
    }
    for (std::size_t side = 0; side < 3; ++side) {
        const std::size_t a = (side + 1) % 3, b = (side + 2) % 3;
        const std::int64_t dx = (x[b] - x[a]) / kParts, dy = (y[b] - y[a]) / kParts;
        facet.towardsX[side] = static_cast<std::int32_t>(-dy);
        facet.towardsY[side] = static_cast<std::int32_t>(dx);
        facet.atMiddle[side] = dy * x[a] - dx * y[a] - (owns(dx, dy) ? 0 : 1);
    }
    facets_.push_back(facet);
    const auto bx = static_cast<double>(x[1] - x[0]), by = static_cast<double>(y[1] - y[0]);
    const auto cx = static_cast<double>(x[2] - x[0]), cy = static_cast<double>(y[2] - y[0]);
    const double doubledArea = bx * cy - by * cx;
    const double east = ((height[1] - height[0]) * cy - (height[2] - height[0]) * by) / doubledArea;
    const double north = ((height[2] - height[0]) * bx - (height[1] - height[0]) * cx) / doubledArea;
    planes_.push_back({height[0] - east * static_cast<double>(x[0]) - north * static_cast<double>(y[0]), east, north});
}

/// Walks from a nearby facet to the facet of the place. Each step crosses an edge beyond which the place lies. If there
/// are two such edges, chance decides, because walks with a fixed rule can go round constraints forever. The end does
/// not depend on that choice. If one such edge leads out of the square, another one does not.
std::int32_t Facets::find(const Spot& spot, std::int32_t start) const {
    std::uint32_t chance = 1;
    std::int32_t number = start, before = -1;
    for (std::size_t steps = 4 * facets_.size();; --steps) {
        const Facet& facet = facets_[at(number)];
        const auto within = facet.within(spot);
        if ((within[0] | within[1] | within[2]) >= 0 || steps == 0) {
            return number;
        }
        chance = chance * 1664525U + 1013904223U;
        std::size_t side = (chance >> 16U) % 3;
        std::int32_t next = -1;
        for (int tried = 0; tried < 3 && next < 0; ++tried, side = side == 2 ? 0 : side + 1) {
            next = within[side] < 0 && facet.beyond[side] != before ? facet.beyond[side] : -1;
        }
        if (next < 0) {
            return number;
        }
        before = std::exchange(number, next);
    }
}

Dual Facets::tangent(double x, double y) const {
    const double freeX = x * partsPerSceneUnit_ - middleX_, freeY = y * partsPerSceneUnit_ - middleY_;
    const double fromX = std::clamp(freeX, west_, east_), fromY = std::clamp(freeY, south_, north_);
    const Spot spot{nearest(fromX), nearest(fromY)};
    const Plane& plane = planes_[at(find(spot, starts_[startOf(fromX, fromY)]))];
    return {plane.height + plane.east * static_cast<double>(spot.x) + plane.north * static_cast<double>(spot.y),
            {fromX == freeX ? plane.east * partsPerSceneUnit_ : 0,
             fromY == freeY ? plane.north * partsPerSceneUnit_ : 0, 0}};
}

}  // namespace sand::force
