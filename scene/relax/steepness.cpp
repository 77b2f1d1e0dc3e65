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
    Tile(const sand::HeightField& field, const sand::Ground& ground, const sand::CellRect& cells, double aspect)
        : field_(field), cells_(cells), aspect_(aspect), held_(field, cells, &ground, nullptr) {}

    [[nodiscard]] double steepest() const {
        double steepest = 0;
        for (int y = cells_.y0; y < cells_.y1; ++y) {
            for (int x = cells_.x0; x < cells_.x1; ++x) {
                if (x + 1 < field_.columns() && canFlow(x, y, x + 1, y)) {
                    const double along = 0.25 / aspect_ * (riseNorth(x, y) + riseNorth(x + 1, y));
                    steepest = std::max(steepest, std::hypot(height(x, y) - height(x + 1, y), along));
                }
                if (y + 1 < field_.rows() && canFlow(x, y, x, y + 1)) {
                    const double across = (height(x, y) - height(x, y + 1)) / aspect_;
                    const double along = 0.25 * (riseEast(x, y) + riseEast(x, y + 1));
                    steepest = std::max(steepest, std::hypot(across, along));
                }
            }
        }
        return steepest;
    }

private:
    [[nodiscard]] std::size_t index(int x, int y) const {
        const int width = cells_.x1 - cells_.x0 + 2;
        return static_cast<std::size_t>(y - cells_.y0 + 1) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x - cells_.x0 + 1);
    }
    [[nodiscard]] double height(int x, int y) const { return held_.heights[index(x, y)]; }
    [[nodiscard]] double sand(int x, int y) const { return held_.sand[index(x, y)]; }

    [[nodiscard]] bool canFlow(int x, int y, int otherX, int otherY) const {
        const bool down = height(x, y) >= height(otherX, otherY);
        // A wall counts as higher than everything, and has no sand to give.
        return (down ? sand(x, y) : sand(otherX, otherY)) >= kLeastToFlow;
    }
    /// Returns the rise from one cell to another. It counts at most the sand of the upper cell.
    [[nodiscard]] double rise(int x, int y, int otherX, int otherY) const {
        return std::clamp(height(otherX, otherY) - height(x, y), -sand(x, y), sand(otherX, otherY));
    }
    [[nodiscard]] double riseEast(int x, int y) const { return rise(x - 1, y, x, y) + rise(x, y, x + 1, y); }
    [[nodiscard]] double riseNorth(int x, int y) const { return rise(x, y - 1, x, y) + rise(x, y, x, y + 1); }

    const sand::HeightField& field_;
    sand::CellRect cells_;
    double aspect_;
    sand::grid::FluxLimits held_;
};

}  // namespace

double steepestFace(const sand::HeightField& field, const sand::Rules& rules, const sand::Ground* ground) {
    std::optional<sand::Ground> none;
    const sand::Ground& bed = ground != nullptr ? *ground : none.emplace(field.columns(), field.rows());
    const double aspect = static_cast<double>(rules.aspect) / sand::kUnitsPerCell;
    double steepest = 0;
    for (int y = 0; y < field.rows(); y += kTile) {
        for (int x = 0; x < field.columns(); x += kTile) {
            const sand::CellRect cells = sand::CellRect{x, y, x + kTile, y + kTile}.clippedTo(field.bounds());
            steepest = std::max(steepest, Tile(field, bed, cells, aspect).steepest());
        }
    }
    return steepest;
}

}  // namespace scene::relax
