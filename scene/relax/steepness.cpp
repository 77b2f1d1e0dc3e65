// SPDX-License-Identifier: Apache-2.0
#include "scene/relax/steepness.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sand/grid/flux_limits.hpp"

namespace scene::relax {
namespace {

constexpr int kTile = 256;       // [cell], side of the tile that is copied at a time
constexpr int kLeastToFlow = 4;  // [unit]; a face gives at most a quarter of a cell's sand

/// Slopes of the faces east and north of a tile's cells.
class Tile {
public:
    Tile(const sand::HeightField& field, const sand::Ground& ground, const sand::CellRect& cells,
         const sand::Rules& rules)
        : field_(field),
          cells_(cells),
          aspect_(static_cast<double>(rules.aspect) / sand::kUnitsPerCell),
          start_(rules.tuning.startThreshold),
          held_(field, cells, ground, nullptr) {}

    [[nodiscard]] double steepest() const {
        double steepest = 0;
        for (int y = cells_.y0; y < cells_.y1; ++y) {
            for (int x = cells_.x0; x < cells_.x1; ++x) {
                const Cell here{x, y}, east{x + 1, y}, north{x, y + 1};
                if (x + 1 < field_.columns() && giver(here, east) >= kLeastToFlow) {
                    const double sand = giver(here, east);
                    const double along = 0.25 / aspect_ * (riseNorth(here, sand) + riseNorth(east, sand));
                    steepest = std::max(steepest, std::hypot(height(here) - height(east), along));
                }
                if (y + 1 < field_.rows() && giver(here, north) >= kLeastToFlow) {
                    const double sand = giver(here, north);
                    const double across = (height(here) - height(north)) / aspect_;
                    const double along = 0.25 * (riseEast(here, sand) + riseEast(north, sand));
                    steepest = std::max(steepest, std::hypot(across, along));
                }
            }
        }
        return steepest;
    }

private:
    struct Cell {
        int x, y;
    };
    [[nodiscard]] std::size_t index(const Cell& cell) const {
        const int width = cells_.x1 - cells_.x0 + 2;
        return static_cast<std::size_t>(cell.y - cells_.y0 + 1) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(cell.x - cells_.x0 + 1);
    }
    [[nodiscard]] double height(const Cell& cell) const { return held_.heights[index(cell)]; }
    [[nodiscard]] double sand(const Cell& cell) const { return held_.sand[index(cell)]; }

    /// Returns the sand of the upper cell of a face [unit]. A wall counts as higher than everything, and has none.
    [[nodiscard]] double giver(const Cell& a, const Cell& b) const { return sand(height(a) >= height(b) ? a : b); }
    /// Returns the rise from one cell to another, as a face counts it whose upper cell has `giving` units of sand.
    /// `start` is the start threshold along the rise [unit]. docs/sand.md has the rule.
    [[nodiscard]] double rise(const Cell& from, const Cell& to, double start, double giving) const {
        const double step = height(to) - height(from);
        const double thickness = sand(step > 0 ? to : from);
        const double thin = std::min(std::abs(step), start) * std::min(1.0, 4 * thickness / std::max(giving, 1.0));
        return std::copysign(std::max(std::min(std::abs(step), thickness), thin), step);
    }
    // Returns how much higher the next cell is than the one before. Beyond the rim the last rise continues.
    [[nodiscard]] double riseEast(const Cell& cell, double giving) const {
        const auto rises = [&](int x) { return rise({x - 1, cell.y}, {x, cell.y}, start_, giving); };
        return bothOf(cell.x, field_.columns(), rises);
    }
    [[nodiscard]] double riseNorth(const Cell& cell, double giving) const {
        const auto rises = [&](int y) { return rise({cell.x, y - 1}, {cell.x, y}, start_ * aspect_, giving); };
        return bothOf(cell.y, field_.rows(), rises);
    }
    template <class Rise>
    static double bothOf(int place, int count, const Rise& riseTo) {
        if (count == 1) {
            return 0;
        }
        return riseTo(std::max(place, 1)) + riseTo(std::min(place + 1, count - 1));
    }

    const sand::HeightField& field_;
    sand::CellRect cells_;
    double aspect_;
    double start_;  // [unit]
    sand::grid::FluxLimits held_;
};

}  // namespace

double steepestFace(const sand::HeightField& field, const sand::Rules& rules, const sand::Ground* ground) {
    std::optional<sand::Ground> none;
    const sand::Ground& bed = ground != nullptr ? *ground : none.emplace(field.columns(), field.rows());
    double steepest = 0;
    for (int y = 0; y < field.rows(); y += kTile) {
        for (int x = 0; x < field.columns(); x += kTile) {
            const sand::CellRect cells = sand::CellRect{x, y, x + kTile, y + kTile}.clippedTo(field.bounds());
            steepest = std::max(steepest, Tile(field, bed, cells, rules).steepest());
        }
    }
    return steepest;
}

}  // namespace scene::relax
