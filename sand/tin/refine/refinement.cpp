// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/refine/refinement.hpp"

#include <algorithm>
#include <set>
#include <tuple>

namespace sand::tin {
namespace {

std::int64_t square(std::int32_t coordinate, std::int32_t spacing) { return coordinate / spacing; }

/// The squares of a lattice that a box touches. Each is free or taken.
class Squares {
public:
    Squares(const Box& box, std::int32_t spacing)
        : spacing_(spacing),
          x0_(square(box.x0, spacing)),
          y0_(square(box.y0, spacing)),
          columns_(square(box.x1, spacing) - x0_ + 1),
          rows_(square(box.y1, spacing) - y0_ + 1),
          taken_(static_cast<std::size_t>(columns_ * rows_)) {}

    void take(const LatticePoint& place) {
        const std::int64_t column = square(place.x, spacing_) - x0_, row = square(place.y, spacing_) - y0_;
        if (column >= 0 && column < columns_ && row >= 0 && row < rows_) {
            taken_[static_cast<std::size_t>(row * columns_ + column)] = true;
        }
    }
    /// Takes all squares whose middle is nearer to the edge than `distance`.
    void takeBeside(const LatticePoint& from, const LatticePoint& to, std::int32_t distance) {
        const std::int32_t x0 = std::min(from.x, to.x) - distance, x1 = std::max(from.x, to.x) + distance;
        const std::int32_t y0 = std::min(from.y, to.y) - distance, y1 = std::max(from.y, to.y) + distance;
        for (std::int32_t y = std::max(y0, 0); y < y1 + spacing_; y += spacing_) {
            for (std::int32_t x = std::max(x0, 0); x < x1 + spacing_; x += spacing_) {
                if (isNear(middleOf(square(x, spacing_), square(y, spacing_)), from, to, distance)) {
                    take({x, y});
                }
            }
        }
    }
    /// Calls `use` with the middle of each free square.
    template <class Use>
    void forEachFree(const Use& use) const {
        for (std::int64_t row = 0; row < rows_; ++row) {
            for (std::int64_t column = 0; column < columns_; ++column) {
                if (!taken_[static_cast<std::size_t>(row * columns_ + column)]) {
                    use(middleOf(x0_ + column, y0_ + row));
                }
            }
        }
    }

private:
    [[nodiscard]] LatticePoint middleOf(std::int64_t column, std::int64_t row) const {
        return {static_cast<std::int32_t>(column * spacing_ + spacing_ / 2),
                static_cast<std::int32_t>(row * spacing_ + spacing_ / 2)};
    }

    std::int32_t spacing_;
    std::int64_t x0_, y0_, columns_, rows_;
    std::vector<bool> taken_;
};

}  // namespace

int refine(Mesh& mesh, const DetailRules& rules, const Box& box, const std::function<bool(const LatticePoint&)>& wanted,
           std::span<const LatticePoint> there, const Edges& edges) {
    const Box inside = box.clippedTo(mesh.triangles());
    if (rules.spacing <= 0 || inside.empty()) {
        return 0;
    }
    Squares squares(inside, rules.spacing);
    for (const LatticePoint& place : there) {
        squares.take(place);
    }
    for (const auto& [from, to] : edges) {
        squares.takeBeside(from, to, rules.spacing / 4);
    }
    std::vector<LatticePoint> places;
    const int room = rules.maxVertices - mesh.vertexCount();
    squares.forEachFree([&](const LatticePoint& middle) {
        const bool within = middle.x <= mesh.triangles().width && middle.y <= mesh.triangles().depth;
        if (static_cast<int>(places.size()) < room && within && wanted(middle)) {
            places.push_back(middle);
        }
    });
    mesh.insert(places);
    return static_cast<int>(places.size());
}

int refineRim(Mesh& mesh, const DetailRules& rules, const Box& box,
              const std::function<bool(const LatticePoint&)>& wanted, std::span<const LatticePoint> there) {
    const Triangles& field = mesh.triangles();
    const Box inside = box.clippedTo(field);
    if (rules.spacing <= 0 || inside.empty()) {
        return 0;
    }
    std::vector<LatticePoint> places;
    const int room = rules.maxVertices - mesh.vertexCount();
    // Adds one side of the field, y = `level`. With `turned`, x and y are swapped.
    const auto addSide = [&](bool turned, std::int32_t level) {
        const auto swapped = [turned](const LatticePoint& place) {
            return turned ? LatticePoint{place.y, place.x} : place;
        };
        const LatticePoint from = swapped({inside.x0, inside.y0}), to = swapped({inside.x1, inside.y1});
        const std::int64_t first = square(from.x, rules.spacing), last = square(to.x, rules.spacing);
        if (level < from.y || level > to.y) {
            return;
        }
        std::vector<bool> taken(static_cast<std::size_t>(last - first + 1));
        for (const LatticePoint& place : there) {
            const LatticePoint own = swapped(place);
            const std::int64_t number = square(own.x, rules.spacing);
            if (own.y == level && number >= first && number <= last) {
                taken[static_cast<std::size_t>(number - first)] = true;
            }
        }
        for (std::int64_t number = first; number <= last; ++number) {
            const auto along = static_cast<std::int32_t>(number * rules.spacing + rules.spacing / 2);
            const LatticePoint place = swapped({along, level});
            if (!taken[static_cast<std::size_t>(number - first)] && static_cast<int>(places.size()) < room &&
                place.x <= field.width && place.y <= field.depth && wanted(place)) {
                places.push_back(place);
            }
        }
    };
    addSide(false, 0);
    addSide(false, field.depth);
    addSide(true, 0);
    addSide(true, field.width);
    mesh.insert(places);
    return static_cast<int>(places.size());
}

int refineHoles(Mesh& mesh, const DetailRules& rules, const Box& box,
                const std::function<bool(const LatticePoint&)>& wanted, std::span<const LatticePoint> there) {
    const Box inside = box.clippedTo(mesh.triangles());
    if (rules.spacing <= 0 || inside.empty() || mesh.holes() == nullptr) {
        return 0;
    }
    // A square's part of a line, by the line's direction and level and by the number of the square.
    using Stretch = std::tuple<bool, std::int32_t, std::int32_t>;
    std::set<Stretch> taken;
    for (const LatticePoint& place : there) {
        taken.emplace(false, place.y, place.x / rules.spacing);
        taken.emplace(true, place.x, place.y / rules.spacing);
    }
    std::vector<LatticePoint> places;
    const int room = rules.maxVertices - mesh.vertexCount();
    mesh.holes()->forEachPart(inside.x0, inside.y0, inside.x1, inside.y1, [&](const Holes::Part& part) {
        const bool upright = part.from.x == part.to.x;
        const auto turned = [upright](const LatticePoint& place) {
            return upright ? LatticePoint{place.y, place.x} : place;
        };
        const LatticePoint from = turned(part.from), to = turned(part.to);
        const LatticePoint first = turned({inside.x0, inside.y0}), last = turned({inside.x1, inside.y1});
        const std::int32_t west = std::max(from.x + rules.spacing / 4, first.x);
        const std::int32_t east = std::min(to.x - rules.spacing / 4, last.x);
        for (std::int32_t number = west / rules.spacing; number * rules.spacing <= east; ++number) {
            const std::int32_t along = number * rules.spacing + rules.spacing / 2;
            const LatticePoint place = turned({along, from.y});
            if (along >= west && along <= east && static_cast<int>(places.size()) < room && wanted(place) &&
                taken.emplace(upright, from.y, number).second) {
                places.push_back(place);
            }
        }
    });
    mesh.insert(places);
    return static_cast<int>(places.size());
}

}  // namespace sand::tin
