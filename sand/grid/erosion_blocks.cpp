// SPDX-License-Identifier: Apache-2.0
// Choice of the blocks that are swept, and their division into patches.
#include <algorithm>
#include <numeric>

#include "sand/grid/erosion.hpp"
#include "sand/grid/erosion_kernel.hpp"

namespace sand::grid {
namespace {

constexpr int kSharedPatch = 32;  // [cell], height of a patch if several threads share the work

}  // namespace

void Erosion::wakeAll() {
    active_.resize(waiting_.size());
    std::iota(active_.begin(), active_.end(), 0);
}

CellRect Erosion::cellsOf(const CellRect& blocks) const {
    return CellRect{blocks.x0 * blockSize_, blocks.y0 * blockSize_, blocks.x1 * blockSize_, blocks.y1 * blockSize_}
        .clippedTo(east_.bounds());
}

CellRect Erosion::blocksAround(const CellRect& cells) const {
    return CellRect{cells.x0 / blockSize_ - 1, cells.y0 / blockSize_ - 1, (cells.x1 - 1) / blockSize_ + 2,
                    (cells.y1 - 1) / blockSize_ + 2}
        .clippedTo({0, 0, across_, down_});
}

void Erosion::collectMarked() {
    active_.clear();
    marked_.takeAll([this](int block) { active_.push_back(block); });
}

void Erosion::touch(const CellRect& cells) {
    if (!cells.empty()) {
        marked_.add(blocksAround(cells));
        undisturbed_ = 0;
    }
}

void Erosion::wakeTouched() {
    if (marked_.empty()) {
        return;
    }
    for (const int block : active_) {
        const int x = block % across_;
        const int y = block / across_;
        marked_.add({x, y, x + 1, y + 1});
    }
    collectMarked();
}

void Erosion::collectPatches(HeightField& field) {
    for (const int block : active_) {
        waiting_[static_cast<std::size_t>(block)] = 1;
    }
    patches_.clear();
    for (const int block : active_) {
        if (waiting_[static_cast<std::size_t>(block)] != 0) {
            patches_.push_back(takePatch(block));
            refreshGhosts(field, cellsOf(patches_.back()));
        }
    }
    outflows_.assign(patches_.size(), 0);
}

CellRect Erosion::takePatch(int block) {
    const int x0 = block % across_;
    const int y0 = block / across_;
    const auto waiting = [this](int x, int y) {
        return x >= 0 && x < across_ && waiting_[static_cast<std::size_t>(y * across_ + x)] != 0;
    };
    CellRect blocks{x0, y0, x0 + 1, y0};
    const int longest = x0 + kMaxPatch / blockSize_;
    // Higher patches are slower: a column of patches that are 2048 cells high runs through the whole field once per
    // patch, which takes a third longer.
    const int high = options_.executor != nullptr ? kSharedPatch : kMaxBlock;
    const int highest = std::min(y0 + std::max(high / blockSize_, 1), down_);
    while (blocks.x1 < longest && waiting(blocks.x1, y0)) {
        ++blocks.x1;
    }
    const auto sameRun = [&](int y) {
        int x = x0;
        while (x < blocks.x1 && waiting(x, y)) {
            ++x;
        }
        return x == blocks.x1 && !waiting(x0 - 1, y) && (x == longest || !waiting(x, y));
    };
    do {
        for (int x = x0; x < blocks.x1; ++x) {
            waiting_[static_cast<std::size_t>(blocks.y1 * across_ + x)] = 0;
        }
        ++blocks.y1;
    } while (blocks.y1 < highest && sameRun(blocks.y1));
    return blocks;
}

void Erosion::markAroundMoved() {
    const auto forEachRow = [this](const auto& task) {
        for (const CellRect& blocks : patches_) {
            for (int y = blocks.y0; y < blocks.y1; ++y) {
                task(CellRect{blocks.x0, y, blocks.x1, y + 1});
            }
        }
    };
    forEachRow([this](const CellRect& run) {
        moved_.addChanged(run, flowed_);
        marked_.addBeside(run, flowed_);
    });
    // Only now, because a run reads the bits of the runs beside it.
    forEachRow([this](const CellRect& run) {
        std::fill(flowed_.row(run.y0) + run.x0, flowed_.row(run.y0) + run.x1, std::uint8_t{0});
    });
}

std::vector<CellRect> Erosion::takeMoved() {
    std::vector<CellRect> runs = moved_.takeRuns();
    std::ranges::transform(runs, runs.begin(), [this](const CellRect& run) { return cellsOf(run); });
    return runs;
}

}  // namespace sand::grid
