// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/geometry/holes.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

namespace sand::tin {
namespace {

constexpr std::int32_t kBridgesPerCell = 8;

std::int64_t downwards(std::int64_t value, std::int64_t by /* positive */) {
    return value >= 0 ? value / by : -((-value + by - 1) / by);
}

std::int32_t lineOf(int number, std::int32_t first, std::int32_t spacing, std::int32_t most) {
    return static_cast<std::int32_t>(
        std::clamp<std::int64_t>(first + std::int64_t{number} * spacing - spacing / 2, 0, most));
}

int numberOf(std::int64_t at, int scale, std::int32_t first, std::int32_t spacing) {
    return static_cast<int>(downwards(at - std::int64_t{scale} * (first - spacing / 2), std::int64_t{scale} * spacing));
}

/// Returns whether the four cells around a corner are hole and ground by turns.
bool isPinched(bool northEast, bool northWest, bool southWest, bool southEast) {
    return northEast != northWest && northEast == southWest && northWest == southEast;
}

/// Finds the outline of holes. Walks along all lines between cells, with one bit per cell. With runs, each step would
/// have to search for its run.
class Outliner {
public:
    explicit Outliner(const Holes& holes) : cells_(holes.cells()), bridge_(holes.bridge()) {
        bits_.resize(static_cast<std::size_t>(cells_.columns) * static_cast<std::size_t>(cells_.rows));
        for (const Holes::Run& run : holes.runs()) {
            std::fill_n(bits_.begin() + static_cast<std::ptrdiff_t>(index(run.first, run.row)), run.end - run.first,
                        true);
        }
    }

    std::size_t level = 0, upright = 0;  // ends of the level and of the upright parts in outline()

    std::vector<Holes::Part> outline() {
        for (int row = 1; row < cells_.rows; ++row) {
            addBorderSouthOf(row);
        }
        level = parts_.size();
        for (int column = 1; column < cells_.columns; ++column) {
            addBorderWestOf(column);
        }
        upright = parts_.size();
        for (int row = 1; row < cells_.rows; ++row) {
            for (int column = 1; column < cells_.columns; ++column) {
                if (isPinch(column, row)) {
                    addPinch(column, row);
                }
            }
        }
        return std::move(parts_);
    }

private:
    [[nodiscard]] std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(cells_.columns) +
               static_cast<std::size_t>(column);
    }
    [[nodiscard]] bool isHole(int column, int row) const { return bits_[index(column, row)]; }
    [[nodiscard]] bool isPinch(int column, int row) const {
        return column > 0 && row > 0 && column < cells_.columns && row < cells_.rows &&
               isPinched(isHole(column, row), isHole(column - 1, row), isHole(column - 1, row - 1),
                         isHole(column, row - 1));
    }

    void addBorderSouthOf(int row) {
        const std::int32_t y = cells_.south(row);
        for (int column = 0; column < cells_.columns;) {
            const int first = column;
            const bool here = isHole(column, row), there = isHole(column, row - 1);
            while (column < cells_.columns && isHole(column, row) == here && isHole(column, row - 1) == there) {
                ++column;
            }
            if (here != there) {
                parts_.push_back({{cells_.west(first) + (isPinch(first, row) ? bridge_ : 0), y},
                                  {cells_.west(column) - (isPinch(column, row) ? bridge_ : 0), y}});
            }
        }
    }

    void addBorderWestOf(int column) {
        const std::int32_t x = cells_.west(column);
        for (int row = 0; row < cells_.rows;) {
            const int first = row;
            const bool here = isHole(column, row), there = isHole(column - 1, row);
            while (row < cells_.rows && isHole(column, row) == here && isHole(column - 1, row) == there) {
                ++row;
            }
            if (here != there) {
                parts_.push_back({{x, cells_.south(first) + (isPinch(column, first) ? bridge_ : 0)},
                                  {x, cells_.south(row) - (isPinch(column, row) ? bridge_ : 0)}});
            }
        }
    }

    /// Adds those corners of the square around the pinch that lie on ground.
    void addPinch(int column, int row) {
        const std::int32_t x = cells_.west(column), y = cells_.south(row);
        const std::int32_t east = isHole(column, row) ? -bridge_ : bridge_;  // of the northern corner
        for (const std::int32_t side : {1, -1}) {
            const LatticePoint corner{x + side * east, y + side * bridge_};
            parts_.push_back({{x, corner.y}, corner});
            parts_.push_back({corner, {corner.x, y}});
        }
    }

    const Cells& cells_;
    std::int32_t bridge_;
    std::vector<bool> bits_;
    std::vector<Holes::Part> parts_;
};

}  // namespace

std::int32_t Cells::west(int column) const { return lineOf(column, first.x, spacing.x, width); }
std::int32_t Cells::south(int row) const { return lineOf(row, first.y, spacing.y, depth); }
int Cells::columnOf(std::int64_t x, int scale) const { return numberOf(x, scale, first.x, spacing.x); }
int Cells::rowOf(std::int64_t y, int scale) const { return numberOf(y, scale, first.y, spacing.y); }

Holes::Holes(const Cells& cells, std::vector<Run> runs)
    : cells_(cells),
      runs_(std::move(runs)),
      bridge_(std::max(std::min(cells.spacing.x, cells.spacing.y) / kBridgesPerCell, 1)) {
    if (runs_.empty()) {
        throw std::invalid_argument("holes without a run of cells");
    }
    firstRun_.assign(static_cast<std::size_t>(cells_.rows) + 1, 0);
    const Run* before = nullptr;
    for (const Run& run : runs_) {
        const bool inside =
            run.row >= 0 && run.row < cells_.rows && run.first >= 0 && run.first < run.end && run.end <= cells_.columns;
        if (!inside ||
            (before != nullptr && (run.row < before->row || (run.row == before->row && run.first <= before->end)))) {
            throw std::invalid_argument("holes out of order or outside the field");
        }
        before = &run;
        ++firstRun_[static_cast<std::size_t>(run.row) + 1];
    }
    for (std::size_t row = 0; row + 1 < firstRun_.size(); ++row) {
        firstRun_[row + 1] += firstRun_[row];
    }
    Outliner outliner(*this);
    outline_ = outliner.outline();
    level_ = outliner.level;
    upright_ = outliner.upright;
}

bool Holes::isHole(int column, int row) const {
    if (column < 0 || row < 0 || column >= cells_.columns || row >= cells_.rows) {
        return true;
    }
    const auto begin = runs_.begin() + firstRun_[static_cast<std::size_t>(row)];
    const auto end = runs_.begin() + firstRun_[static_cast<std::size_t>(row) + 1];
    const auto after = std::upper_bound(begin, end, column, [](int at, const Run& run) { return at < run.first; });
    return after != begin && std::prev(after)->end > column;
}

bool Holes::isPinch(int column, int row) const {
    if (column <= 0 || row <= 0 || column >= cells_.columns || row >= cells_.rows) {
        return false;
    }
    return isPinched(isHole(column, row), isHole(column - 1, row), isHole(column - 1, row - 1),
                     isHole(column, row - 1));
}

bool Holes::holds(std::int64_t x, std::int64_t y, int scale) const {
    const int column = cells_.columnOf(x, scale), row = cells_.rowOf(y, scale);
    if (isHole(column, row)) {
        return true;
    }
    if (upright_ == outline_.size()) {  // there is no pinch, as in most scenes
        return false;
    }
    for (int north = 0; north < 2; ++north) {
        for (int east = 0; east < 2; ++east) {
            if (std::abs(x - std::int64_t{scale} * cells_.west(column + east)) < std::int64_t{scale} * bridge_ &&
                std::abs(y - std::int64_t{scale} * cells_.south(row + north)) < std::int64_t{scale} * bridge_ &&
                isPinch(column + east, row + north)) {
                return true;
            }
        }
    }
    return false;
}

bool Holes::holds(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c) const {
    // The centroid lies within the triangle.
    return holds(std::int64_t{a.x} + b.x + c.x, std::int64_t{a.y} + b.y + c.y, 3);
}

bool Holes::borders(const LatticePoint& a, const LatticePoint& b) const {
    if ((a.x == b.x) == (a.y == b.y)) {
        return false;
    }
    // Tests places beside the edge's middle. They are a quarter of a unit away. Every lattice place that is not on a
    // line is farther from it.
    const std::int64_t x = 2 * (std::int64_t{a.x} + b.x), y = 2 * (std::int64_t{a.y} + b.y);
    const int across = a.x == b.x ? 1 : 0, along = 1 - across;
    return holds(x + across, y + along, 4) != holds(x - across, y - along, 4);
}

bool Holes::reachInto(const LatticePoint& southWest, const LatticePoint& northEast) const {
    const int west = std::max(cells_.columnOf(southWest.x - bridge_), 0);
    const int east = std::min(cells_.columnOf(northEast.x + bridge_), cells_.columns - 1);
    const int south = std::max(cells_.rowOf(southWest.y - bridge_), 0);
    const int north = std::min(cells_.rowOf(northEast.y + bridge_), cells_.rows - 1);
    for (int row = south; row <= north && west <= east; ++row) {
        const auto begin = runs_.begin() + firstRun_[static_cast<std::size_t>(row)];
        const auto end = runs_.begin() + firstRun_[static_cast<std::size_t>(row) + 1];
        const auto run = std::lower_bound(begin, end, west, [](const Run& one, int at) { return one.end <= at; });
        if (run != end && run->first <= east) {
            return true;
        }
    }
    return false;
}

}  // namespace sand::tin
