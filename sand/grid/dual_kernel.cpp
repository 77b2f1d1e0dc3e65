// SPDX-License-Identifier: Apache-2.0
// Compiled once for every x86-64 and once for x86-64-v3, with -O3, because g++ 12 does not vectorise these loops at
// -O2.
#include "sand/grid/dual_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sand::grid::SANDWALL_CODE_PATH {
namespace {

/// Row of quads.
struct QuadRow {
    double *x, *y, *twist;
};

void extrapolate(const double* __restrict now, const double* __restrict before, double momentum, int count,
                 double* __restrict result) {
    for (int i = 0; i < count; ++i) {
        result[i] = now[i] + momentum * (now[i] - before[i]);
    }
}

/// Computes a row of heights: the start minus the divergence of the quads below and above it. Quad i lies east of cell
/// i.
void heights(const double* __restrict start, const double* __restrict xBelow, const double* __restrict yBelow,
             const double* __restrict twistBelow, const double* __restrict xAbove, const double* __restrict yAbove,
             const double* __restrict twistAbove, double northing, double twist, int count, double* __restrict result) {
    for (int i = 0; i < count; ++i) {
        const double west = (xBelow[i - 1] + xAbove[i - 1]) + twist * (twistBelow[i - 1] - twistAbove[i - 1]);
        const double east = (xBelow[i] + xAbove[i]) + twist * (twistBelow[i] - twistAbove[i]);
        const double north = northing * ((yBelow[i - 1] - yAbove[i - 1]) + (yBelow[i] - yAbove[i]));
        result[i] = start[i] - 0.5 * ((west - east) + north);
    }
}

/// Takes a step up the gradient, which is the slope, and then shrinks the result by the threshold. Each quad has two
/// cells in the row `below` and two in the row `above`.
void step(const DualIteration& it, const double* __restrict below, const double* __restrict above,
          const double* __restrict x, const double* __restrict y, const double* __restrict twist,
          const double* __restrict xNow, const double* __restrict yNow, const double* __restrict twistNow, int count,
          double* __restrict xNew, double* __restrict yNew, double* __restrict twistNew, double* __restrict turn) {
    const double half = 0.5 * it.step;
    const double halfNorthing = half * it.northing;
    const double halfTwist = half * it.twist;
    const double shrinkage = it.step * it.threshold;
    for (int i = 0; i < count; ++i) {
        const double south = below[i + 1] - below[i];
        const double north = above[i + 1] - above[i];
        const double west = above[i] - below[i];
        const double east = above[i + 1] - below[i + 1];
        const double longX = x[i] + half * (south + north);
        const double longY = y[i] + halfNorthing * (west + east);
        const double longTwist = twist[i] + halfTwist * (north - south);
        const double length = std::sqrt(longX * longX + longY * longY + longTwist * longTwist);
        const double share = length > shrinkage ? 1.0 - shrinkage / length : 0.0;
        const double shortX = share * longX;
        const double shortY = share * longY;
        const double shortTwist = share * longTwist;
        turn[i] += (x[i] - shortX) * (shortX - xNow[i]) + (y[i] - shortY) * (shortY - yNow[i]) +
                   (twist[i] - shortTwist) * (shortTwist - twistNow[i]);
        xNew[i] = shortX;
        yNew[i] = shortY;
        twistNew[i] = shortTwist;
    }
}

void measureQuads(const DualIteration& it, const double* __restrict below, const double* __restrict above,
                  const double* __restrict x, const double* __restrict y, const double* __restrict twist, int count,
                  double* __restrict gap, double* __restrict excess) {
    for (int i = 0; i < count; ++i) {
        const double south = below[i + 1] - below[i];
        const double north = above[i + 1] - above[i];
        const double slopeX = 0.5 * (south + north);
        const double slopeY = 0.5 * it.northing * (above[i] - below[i] + (above[i + 1] - below[i + 1]));
        const double slopeTwist = 0.5 * it.twist * (north - south);
        const double slope = std::sqrt(slopeX * slopeX + slopeY * slopeY + slopeTwist * slopeTwist);
        excess[i] = std::max(excess[i], slope - it.threshold);
        gap[i] += it.threshold * std::sqrt(x[i] * x[i] + y[i] * y[i] + twist[i] * twist[i]) -
                  (x[i] * slopeX + y[i] * slopeY + twist[i] * slopeTwist);
    }
}

void measureCells(const double* __restrict start, const double* __restrict height, int count,
                  double* __restrict moved) {
    for (int i = 0; i < count; ++i) {
        moved[i] += (height[i] - start[i]) * (height[i] - start[i]);
    }
}

/// One pass up the rows. It extrapolates a row of quads and computes the cells below it from the quads on both sides.
/// Then it computes the quads below these cells from the cells on both sides.
class Iteration {
public:
    explicit Iteration(const DualIteration& it)
        : it_(it), whole_((it.columns + kDualLanes - 1) / kDualLanes * kDualLanes) {
        std::fill_n(it.scratch, kDualRows * it.stride, 0.0);
        const auto row = [&it](int i) { return it.scratch + i * it.stride + kDualLanes; };
        quadsBelow_ = {row(0), row(1), row(2)};
        quads_ = {row(3), row(4), row(5)};
        cellsBelow_ = row(6);
        cells_ = row(7);
    }

    void run() {
        for (int y = 0; y < it_.rows; ++y) {
            const std::ptrdiff_t offset = y * it_.stride;
            extrapolateQuads(y);
            heights(it_.start + offset, quadsBelow_.x, quadsBelow_.y, quadsBelow_.twist, quads_.x, quads_.y,
                    quads_.twist, it_.northing, it_.twist, whole_, cells_);
            holdCells(y);
            if (it_.measure) {
                measureCells(it_.start + offset, cells_, it_.columns, it_.moved);
            }
            if (y > 0) {
                stepQuads(offset - it_.stride);
            }
            std::swap(quadsBelow_, quads_);
            std::swap(cellsBelow_, cells_);
        }
    }

private:
    void extrapolateQuads(int y) {
        const std::array<double*, 3> rows{quads_.x, quads_.y, quads_.twist};
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (y + 1 < it_.rows) {
                extrapolate(it_.now[i] + y * it_.stride, it_.before[i] + y * it_.stride, it_.momentum, whole_, rows[i]);
            } else {
                std::fill_n(rows[i], whole_, 0.0);
            }
        }
    }

    void holdCells(int y) {
        const double* start = it_.start + y * it_.stride;
        if ((it_.heldSouth && y == 0) || (it_.heldNorth && y == it_.rows - 1)) {
            std::copy_n(start, it_.columns, cells_);
        }
        if (it_.heldWest) {
            cells_[0] = start[0];
        }
        if (it_.heldEast) {
            cells_[it_.columns - 1] = start[it_.columns - 1];
        }
    }

    /// Computes the quads between the two rows of cells, then clears what whole vectors wrote behind the last quad.
    void stepQuads(std::ptrdiff_t offset) {
        const int count = it_.columns - 1;
        if (it_.measure) {
            measureQuads(it_, cellsBelow_, cells_, quadsBelow_.x, quadsBelow_.y, quadsBelow_.twist, count, it_.gap,
                         it_.excess);
        }
        step(it_, cellsBelow_, cells_, quadsBelow_.x, quadsBelow_.y, quadsBelow_.twist, it_.now[0] + offset,
             it_.now[1] + offset, it_.now[2] + offset, whole_, it_.before[0] + offset, it_.before[1] + offset,
             it_.before[2] + offset, it_.turn);
        for (double* row : it_.before) {
            std::fill(row + offset + count, row + offset + whole_, 0.0);
        }
    }

    const DualIteration& it_;
    const int whole_;  // columns, rounded up to whole vectors
    QuadRow quadsBelow_{}, quads_{};
    double* cellsBelow_;
    double* cells_;
};

}  // namespace

void iterateDual(const DualIteration& iteration) { Iteration(iteration).run(); }

}  // namespace sand::grid::SANDWALL_CODE_PATH
