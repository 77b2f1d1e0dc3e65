// SPDX-License-Identifier: Apache-2.0
// Choice of the blocks that are swept.
#include <algorithm>

#include "sand/grid/erosion.hpp"
#include "sand/grid/resting_blocks.hpp"

namespace sand::grid {

void Erosion::wakeAll() {
    active_.clear();
    for (int y = 0; y < down_; ++y) {
        active_.push_back({0, y, across_, y + 1});
    }
}

CellRect Erosion::cellsOf(const CellRect& blocks) const {
    return CellRect{blocks.x0 * blockSize_, blocks.y0 * blockSize_, blocks.x1 * blockSize_, blocks.y1 * blockSize_}
        .clippedTo(east_.bounds());
}

std::int64_t Erosion::activeCells() const {
    std::int64_t cells = 0;
    for (const CellRect& run : active_) {
        const CellRect here = cellsOf(run);
        cells += std::int64_t{here.x1 - here.x0} * (here.y1 - here.y0);
    }
    return cells;
}

CellRect Erosion::blocksAround(const CellRect& cells) const {
    return CellRect{cells.x0 / blockSize_ - 1, cells.y0 / blockSize_ - 1, (cells.x1 - 1) / blockSize_ + 2,
                    (cells.y1 - 1) / blockSize_ + 2}
        .clippedTo({0, 0, across_, down_});
}

void Erosion::touch(const CellRect& cells) {
    if (!cells.empty()) {
        wake(cells);
        undisturbed_ = 0;
        packed_.reset();
    }
}

void Erosion::wake(const CellRect& cells) {
    if (!cells.empty()) {
        marked_.add(blocksAround(cells));
    }
}

void Erosion::wakeTouched() {
    if (marked_.empty()) {
        return;
    }
    for (const CellRect& run : active_) {
        marked_.add(run);
    }
    active_ = marked_.takeRuns();
}

void Erosion::markAroundMoved() {
    for (const CellRect& run : active_) {
        moved_.addChanged(run, flowed_);
        marked_.addBeside(run, flowed_);
        std::fill(flowed_.row(run.y0) + run.x0, flowed_.row(run.y0) + run.x1, std::uint8_t{0});
    }
}

void Erosion::leaveOutResting(const HeightField& field) {
    const auto unwritten = [this](const CellRect& run) {
        return written_[static_cast<std::size_t>(run.y0)] == Written::no;
    };
    if (options_.ground != nullptr || !options_.skipSettled ||
        std::none_of(active_.begin(), active_.end(), unwritten)) {
        return;
    }
    RestingBlocks resting(field, rules_, blockSize_, steep_);
    swept_.clear();  // holds the other blocks for a moment, because each sweep sets it again
    for (const CellRect& run : active_) {
        if (unwritten(run)) {
            resting.appendOthers(run, swept_);
        } else {
            swept_.push_back(run);
        }
    }
    active_.swap(swept_);
}

void Erosion::noteWritten() {
    for (const CellRect& run : active_) {
        written_[static_cast<std::size_t>(run.y0)] = Written::lately;
    }
}

void Erosion::releaseRest() {
    constexpr int kCalls = 16;  // rows that are dug again within so many steps keep their memory
    if (++calls_ < kCalls) {
        return;
    }
    calls_ = 0;
    noteWritten();  // active blocks may have fluxes although no sweep was due
    for (int y = 0; y < down_;) {
        Written& row = written_[static_cast<std::size_t>(y)];
        const int first = y++;
        if (row != Written::earlier) {
            row = row == Written::lately ? Written::earlier : Written::no;
            continue;
        }
        row = Written::no;
        for (; y < down_ && written_[static_cast<std::size_t>(y)] == Written::earlier; ++y) {
            written_[static_cast<std::size_t>(y)] = Written::no;
        }
        const int end = std::min(y * blockSize_, east_.rows());
        east_.releaseRows(first * blockSize_, end);
        north_.releaseRows(first * blockSize_, end);
    }
}

std::vector<CellRect> Erosion::takeMoved() {
    std::vector<CellRect> runs = moved_.takeRuns();
    std::transform(runs.begin(), runs.end(), runs.begin(), [this](const CellRect& run) { return cellsOf(run); });
    return runs;
}

}  // namespace sand::grid
