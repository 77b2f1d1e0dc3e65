// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/surroundings.hpp"

#include <algorithm>
#include <optional>
#include <tuple>

namespace sand::grid {
namespace {

constexpr std::int32_t kNothing = -kMaxHeight - 1;  // below every height and all rock

std::int64_t squared(std::int64_t value) { return value * value; }

}  // namespace

Surroundings::Surroundings(const HeightField& field, const Ground& ground, const TurnedShape& shape, ProbePoint probe,
                           const Cut& cut)
    : box_(shape.cellsChanged(probe.x, probe.y).clippedTo(field.bounds())) {
    std::int32_t highest = kNothing;
    for (std::size_t i = 0; i < cut.rows.size(); ++i) {
        const std::int32_t* const heights = field.row(cut.rows[i]) + cut.cells.x0;
        const std::int32_t* const lowest = cut.lowestOf(i);
        for (std::size_t k = 0; k < cut.across(); ++k) {
            highest = std::max(highest, heights[k] > lowest[k] ? heights[k] : kNothing);
        }
    }
    // A wall counts as rock above every height.
    for (int y = box_.y0; y < box_.y1 && !barred_; ++y) {
        const std::int32_t* const bed = ground.cells().row(y);
        std::int32_t most = kNothing;
        for (int x = box_.x0; x < box_.x1; ++x) {
            most = std::max(most, bed[x]);
        }
        for (int x = box_.x0; x < box_.x1 && most > highest && !barred_; ++x) {
            const Offset offset = offsetOf(probe, x, y);
            barred_ = bed[x] > highest && (shape.takes(offset) || shape.covers(offset));
        }
    }
    if (barred_) {
        findCells(field, ground, shape, probe, cut);
        divide(ground);
    }
}

void Surroundings::findCells(const HeightField& field, const Ground& ground, const TurnedShape& shape, ProbePoint probe,
                             const Cut& cut) {
    const std::size_t cells = static_cast<std::size_t>(box_.x1 - box_.x0) * static_cast<std::size_t>(box_.y1 - box_.y0);
    parts_.assign(cells, kNone);
    heights_.assign(cells, kNothing);
    over_.assign(cells, 0);
    for (int y = box_.y0; y < box_.y1; ++y) {
        for (int x = box_.x0; x < box_.x1; ++x) {
            const Offset offset = offsetOf(probe, x, y);
            if (!ground.isWall(x, y) && (shape.takes(offset) || shape.covers(offset))) {
                parts_[index(x, y)] = kWaiting;
            }
        }
    }
    for (std::size_t i = 0; i < cut.rows.size(); ++i) {
        const int y = cut.rows[i];
        for (int x = cut.cells.x0; x < cut.cells.x1; ++x) {
            const std::int32_t height = field.height(x, y);
            const std::int32_t lowest = cut.lowestOf(i)[x - cut.cells.x0];
            if (height > lowest) {
                heights_[index(x, y)] = height;
                over_[index(x, y)] = height - lowest;
            }
        }
    }
}

std::vector<std::size_t> Surroundings::join(std::size_t first, std::int32_t part) {
    const auto across = static_cast<std::size_t>(box_.x1 - box_.x0);
    std::vector<std::size_t> cells{first};
    parts_[first] = part;
    const auto add = [&](bool there, std::size_t cell) {
        if (there && parts_[cell] == kWaiting) {
            parts_[cell] = part;
            cells.push_back(cell);
        }
    };
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const std::size_t cell = cells[i], column = cell % across;
        add(column > 0, cell - 1);
        add(column + 1 < across, cell + 1);
        add(cell >= across, cell - across);
        add(cell + across < parts_.size(), cell + across);
    }
    return cells;
}

void Surroundings::divide(const Ground& ground) {
    const auto across = static_cast<std::size_t>(box_.x1 - box_.x0);
    const auto rockOf = [&](std::size_t cell) {
        return ground.bedrock(box_.x0 + static_cast<int>(cell % across), box_.y0 + static_cast<int>(cell / across));
    };
    std::vector<std::size_t> open(parts_.size());  // cells that may be waiting, the next one last
    for (std::size_t i = 0; i < open.size(); ++i) {
        open[i] = open.size() - 1 - i;
    }
    while (!open.empty()) {
        const std::size_t first = open.back();
        open.pop_back();
        if (parts_[first] != kWaiting) {
            continue;
        }
        const std::vector<std::size_t> cells = join(first, count());
        std::int32_t highest = kNothing;
        std::int64_t taken = 0;
        for (const std::size_t cell : cells) {
            highest = std::max(highest, heights_[cell]);
            taken += over_[cell];
        }
        const auto isTooHigh = [&](std::size_t cell) { return rockOf(cell) > highest; };
        if (taken > 0 && std::any_of(cells.begin(), cells.end(), isTooHigh)) {
            for (const std::size_t cell : cells) {  // the other cells are divided again
                parts_[cell] = isTooHigh(cell) ? kNone : kWaiting;
            }
            open.insert(open.end(), cells.rbegin(), cells.rend());
        } else {
            taken_.push_back(taken);
        }
    }
}

std::int32_t Surroundings::partOf(int column, int row) const {
    const int x = std::clamp(column, box_.x0, box_.x1 - 1), y = std::clamp(row, box_.y0, box_.y1 - 1);
    const std::int32_t part = parts_[index(x, y)];
    return part != kNone || (x == column && y == row) ? part : nearestPart(column, row, x, y);
}

/// Returns the part of the cell nearest to a place beyond the box. (x, y) is the nearest cell of the box.
std::int32_t Surroundings::nearestPart(int column, int row, int x, int y) const {
    struct Found {
        std::int64_t distance;
        int row, column;
        std::int32_t part;
    };
    std::optional<Found> best;
    const auto visit = [&](int cx, int cy) {
        if (cx < box_.x0 || cx >= box_.x1 || cy < box_.y0 || cy >= box_.y1 || parts_[index(cx, cy)] == kNone) {
            return;
        }
        const Found here{squared(column - cx) + squared(row - cy), cy, cx, parts_[index(cx, cy)]};
        if (!best ||
            std::tie(here.distance, here.row, here.column) < std::tie(best->distance, best->row, best->column)) {
            best = here;
        }
    };
    // A cell on the frame `out` cells around (x, y) is at least as far from the place as the root of least + out².
    const std::int64_t least = squared(column - x) + squared(row - y);
    const int sides = std::max(box_.x1 - box_.x0, box_.y1 - box_.y0);
    for (int out = 1; out < sides && (!best || least + squared(out) <= best->distance); ++out) {
        for (int along = -out; along <= out; ++along) {
            visit(x + along, y - out);
            visit(x + along, y + out);
            visit(x - out, y + along);
            visit(x + out, y + along);
        }
    }
    return best ? best->part : kNone;
}

}  // namespace sand::grid
