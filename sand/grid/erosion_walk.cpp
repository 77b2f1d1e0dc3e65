// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/erosion_walk.hpp"

#include <algorithm>
#include <numeric>

namespace sand::grid {
namespace {

// Rows of the buffers of a strip. The first ones are 0 between sweeps.
enum : int {
    kSlidingAtStart,
    kBefore,
    kOld,
    kSliding = kOld + 3,
    kFlowed = kSliding + 9,  // a short run marks nine rows
    kRows = kFlowed + 3
};

// A strip has at least this many cells. Each strip costs a call of the executor, and two rows of cells are read again.
// More strips than threads balance the load, because sand flows in some strips more than in others.
constexpr std::int64_t kLeastStrip = 1 << 12;
constexpr std::int64_t kMostStrips = 32;

/// The kernel that is compiled for an instruction set.
struct Kernel {
    decltype(&baseline::walk) walk;
    decltype(&baseline::balance) balance;
    decltype(&baseline::markSliding) markSliding;
};

Kernel kernelOf(base::CodePath path) {
    switch (path) {
        case base::CodePath::v4:
            return {v4::walk, v4::balance, v4::markSliding};
        case base::CodePath::v3:
            return {v3::walk, v3::balance, v3::markSliding};
        case base::CodePath::baseline:
            break;
    }
    return {baseline::walk, baseline::balance, baseline::markSliding};
}

void forEach(std::size_t count, const base::Executor* executor, const std::function<void(int)>& task) {
    if (executor != nullptr && count > 1) {
        (*executor)(static_cast<int>(count), task);
        return;
    }
    for (std::size_t i = 0; i < count; ++i) {
        task(static_cast<int>(i));
    }
}

}  // namespace

std::size_t ErosionWalk::bytes() const {
    return std::accumulate(buffers_.begin(), buffers_.end(), runs_.capacity() * sizeof(Run),
                           [](std::size_t sum, const CellArray& rows) { return sum + rows.bytes(); });
}

std::int64_t ErosionWalk::sweep(const Sweep& sweep, const std::vector<CellRect>& runs,
                                const Surroundings& surroundings) {
    const Kernel kernel = kernelOf(surroundings.path);
    findRows(runs);
    divide(sweep, surroundings.executor != nullptr);
    const std::size_t strips = strips_.size() - 1;
    for (std::size_t i = 1; sweep.band && i < strips; ++i) {
        // Two strips need these masks, and both overwrite what they are made of.
        kernel.markSliding(sweep, runsOf(strips_[i]), rows_[strips_[i]].y0, buffersOf(i).slidingAtStart);
    }
    outflows_.assign(strips, 0);
    forEach(strips, surroundings.executor, [&](int i) {
        const auto strip = static_cast<std::size_t>(i);
        outflows_[strip] = sweepStrip(sweep, strip, surroundings);
    });
    forEach(strips, surroundings.executor,
            [&](int i) { finishStrip(sweep, static_cast<std::size_t>(i), surroundings.path); });
    return std::accumulate(outflows_.begin(), outflows_.end(), std::int64_t{0});
}

void ErosionWalk::findRows(const std::vector<CellRect>& runs) {
    runs_.clear();
    rows_.clear();
    for (const CellRect& cells : runs) {
        if (rows_.empty() || rows_.back().y0 != cells.y0) {
            rows_.push_back({cells.y0, cells.y1, runs_.size(), runs_.size()});
        }
        runs_.push_back({.x0 = cells.x0, .x1 = cells.x1, .heights = nullptr, .sand = nullptr, .room = nullptr});
        ++rows_.back().end;
    }
}

void ErosionWalk::divide(const Sweep& sweep, bool shared) {
    std::vector<std::int64_t> cells(rows_.size());
    for (std::size_t row = 0; row < rows_.size(); ++row) {
        for (const Run& run : runsOf(row)) {
            cells[row] += std::int64_t{run.x1 - run.x0} * (rows_[row].y1 - rows_[row].y0);
        }
    }
    const std::int64_t all = std::accumulate(cells.begin(), cells.end(), std::int64_t{0});
    const std::int64_t least = shared ? std::max(kLeastStrip, all / kMostStrips) : all;
    strips_.assign(1, 0);
    std::int64_t held = 0;  // by the current strip
    for (std::size_t row = 0; row + 1 < rows_.size(); ++row) {
        held += cells[row];
        if (held >= least && held < all) {
            strips_.push_back(row + 1);
            held = 0;
        }
    }
    strips_.push_back(rows_.size());
    while (buffers_.size() + 1 < strips_.size()) {
        buffers_.emplace_back(sweep.columns, kRows);
    }
}

RowBuffers ErosionWalk::buffersOf(std::size_t strip) {
    CellArray& rows = buffers_[strip];
    return {.old = {rows.row(kOld), rows.row(kOld + 1), rows.row(kOld + 2)},
            .sliding = {rows.row(kSliding), rows.row(kSliding + 1)},
            .slidingStride = rows.stride(),
            .before = rows.row(kBefore),
            .flowed = {rows.row(kFlowed), rows.row(kFlowed + 1), rows.row(kFlowed + 2)},
            .slidingAtStart = rows.row(kSlidingAtStart)};
}

std::span<const Run> ErosionWalk::runsOf(std::size_t row) const {
    return std::span(runs_).subspan(rows_[row].first, rows_[row].end - rows_[row].first);
}

bool ErosionWalk::continues(std::size_t row) const {
    return row + 1 < rows_.size() && rows_[row + 1].y0 == rows_[row].y1;
}

void ErosionWalk::limit(std::size_t row, const Surroundings& surroundings, std::vector<FluxLimits>& limits) {
    if (surroundings.ground == nullptr) {
        return;
    }
    const Row& blocks = rows_[row];
    limits.clear();
    for (std::size_t i = blocks.first; i < blocks.end; ++i) {
        Run& run = runs_[i];
        const CellRect cells{run.x0, blocks.y0, run.x1, blocks.y1};
        const Obstacle* const obstacle = surroundings.obstacle;
        const bool toolNear = obstacle != nullptr && !obstacle->cells.clippedTo(cells.grownBy(1)).empty();
        // Moving a vector does not move its numbers.
        const FluxLimits& made =
            limits.emplace_back(surroundings.field, cells, *surroundings.ground, toolNear ? obstacle : nullptr);
        run.heights = made.heights.data();
        run.sand = made.sand.data();
        run.room = made.room.data();
    }
}

std::int64_t ErosionWalk::sweepStrip(const Sweep& sweep, std::size_t strip, const Surroundings& surroundings) {
    const Kernel kernel = kernelOf(surroundings.path);
    const RowBuffers buffers = buffersOf(strip);
    const std::size_t first = strips_[strip], end = strips_[strip + 1];
    std::vector<FluxLimits> limits;
    std::int64_t outflow = 0;
    for (std::size_t row = first; row < end; ++row) {
        limit(row, surroundings, limits);
        const bool afterRow = row > first && continues(row - 1);
        if (row > first && !afterRow) {
            kernel.balance(sweep, &buffers, runsOf(row - 1), rows_[row - 1].y1 - 1);
        }
        const bool hasStripBelow = row == first && strip > 0;
        const bool hasStripAbove = row + 1 == end && end < rows_.size() && continues(row);
        const BlockRow blocks{.y0 = rows_[row].y0,
                              .y1 = rows_[row].y1,
                              .runs = runsOf(row),
                              .below = afterRow ? runsOf(row - 1) : std::span<const Run>{},
                              .keepsFirst = hasStripBelow,
                              .slidingFirst = hasStripBelow ? buffers.slidingAtStart : nullptr,
                              .slidingAbove = hasStripAbove ? buffersOf(strip + 1).slidingAtStart : nullptr};
        outflow += kernel.walk(sweep, buffers, blocks);
    }
    return outflow;
}

void ErosionWalk::finishStrip(const Sweep& sweep, std::size_t strip, base::CodePath path) {
    const Kernel kernel = kernelOf(path);
    const RowBuffers buffers = buffersOf(strip);
    const std::size_t first = strips_[strip], last = strips_[strip + 1] - 1;
    const int firstCells = rows_[first].y0, lastCells = rows_[last].y1 - 1;
    if (strip > 0 && firstCells != lastCells) {
        kernel.balance(sweep, nullptr, runsOf(first), firstCells);
    }
    kernel.balance(sweep, &buffers, runsOf(last), lastCells);
    for (const Run& run : runsOf(first)) {
        std::fill(buffers.slidingAtStart + run.x0, buffers.slidingAtStart + run.x1, 0);
    }
}

}  // namespace sand::grid
