// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/quad_energy.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <utility>

namespace sand::grid {
namespace {

// Correction of a quad that is too steep, as a multiple of its excess. It is more than 1, because the quad's neighbours
// undo a part. It takes a fifth of the passes that 1 takes.
constexpr double kOverrelaxation = 1.8;
constexpr double kNearlyFlat = 1e-4;  // [threshold], excess at which iterating ends; shrinking does the rest
constexpr int kMostPasses =
    1000;  // rough ground of a thousand cells may take this many; then the heights shrink by more

double slopeOf(const QuadEnergy::Faces& d) {
    return std::sqrt(0.5 * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] + d[3] * d[3]));
}

}  // namespace

QuadEnergy::QuadEnergy(const HeightField& field, const Rules& rules)
    : columns_(field.columns()),
      rows_(field.rows()),
      ring_(rules.rim == Rim::open ? 1 : 0),
      across_(ring_ == 1 ? columns_ + 2 : std::max(columns_, 2)),
      down_(ring_ == 1 ? rows_ + 2 : std::max(rows_, 2)),
      northing_(static_cast<double>(kUnitsPerCell) / rules.aspect),
      heights_(static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_)) {
    for (int y = 0; y + 2 * ring_ < down_; ++y) {
        for (int x = 0; x + 2 * ring_ < across_; ++x) {
            heights_[cell(x, y)] = field.height(std::min(x, columns_ - 1), std::min(y, rows_ - 1));
        }
    }
}

double QuadEnergy::images() const { return ring_ == 1 ? 1.0 : (columns_ == 1 ? 2.0 : 1.0) * (rows_ == 1 ? 2.0 : 1.0); }

QuadEnergy::Faces QuadEnergy::differences(int x, int y) const {
    const double a = heights_[cell(x, y)];
    const double b = heights_[cell(x + 1, y)];
    const double c = heights_[cell(x, y + 1)];
    const double d = heights_[cell(x + 1, y + 1)];
    return {b - a, d - c, northing_ * (c - a), northing_ * (d - b)};
}

double QuadEnergy::steepest() const {
    double steepest = 0;
    forEach([&](int x, int y) { steepest = std::max(steepest, slopeOf(differences(x, y))); });
    return steepest;
}

/// Moves the corners of each quad of a row that is too steep nearer to their mean, or to the ring's height. Returns
/// whether there was a quad that was too steep.
bool QuadEnergy::flattenRow(int y, double threshold) {
    bool moved = false;
    for (int x = -ring_; x + ring_ + 1 < across_; ++x) {
        const double slope = slopeOf(differences(x, y));
        if (slope <= (1 + kNearlyFlat) * threshold) {
            continue;
        }
        const std::array corners{cell(x, y), cell(x + 1, y), cell(x, y + 1), cell(x + 1, y + 1)};
        double level = 0;
        if (!touchesRing(x, y)) {
            for (const std::size_t corner : corners) {
                level += 0.25 * heights_[corner];
            }
        }
        const double kept = 1 - kOverrelaxation * (1 - threshold / slope);
        for (const std::size_t corner : corners) {
            heights_[corner] = level + kept * (heights_[corner] - level);
        }
        moved = true;
    }
    return moved;
}

void QuadEnergy::shrink(double share) {
    const double sum = std::accumulate(heights_.begin(), heights_.end(), 0.0);
    const double level = ring_ == 1 ? 0 : sum / static_cast<double>(heights_.size());
    for (double& height : heights_) {
        height = level + share * (height - level);
    }
}

void QuadEnergy::flatten(double threshold) {
    const int quadRows = down_ - 1;
    std::vector<std::uint8_t> waiting(static_cast<std::size_t>(quadRows) + 2, 1);  // one row more before and one behind
    for (int pass = 0; pass < kMostPasses; ++pass) {
        bool moved = false;
        for (int row = 0; row < quadRows; ++row) {
            std::uint8_t* const flag = waiting.data() + row + 1;
            if (std::exchange(*flag, 0) != 0 && flattenRow(row - ring_, threshold)) {
                std::fill(flag - 1, flag + 2, 1);
                moved = true;
            }
        }
        if (!moved) {
            break;
        }
    }
    const double steepest = this->steepest();
    if (steepest > threshold) {
        shrink(threshold / steepest);
    }
}

double QuadEnergy::squaredDistanceTo(const QuadEnergy& other) const {
    return std::transform_reduce(heights_.begin(), heights_.end(), other.heights_.begin(), 0.0, std::plus<>(),
                                 [](double a, double b) { return (a - b) * (a - b); });
}

}  // namespace sand::grid
