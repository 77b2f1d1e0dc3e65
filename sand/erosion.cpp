// SPDX-License-Identifier: Apache-2.0
#include "sand/erosion.hpp"

#include <algorithm>
#include <numeric>

#include "sand/erosion_kernel.hpp"

namespace sand {
namespace {

bool machineHasV3() {
    // clang 14 knows no "x86-64-v3" here; these three stand for it on every processor that was ever sold.
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
}

/// Beyond the rim the ground goes on as it came: the slope along the rim is then that of the cell's one neighbour.
std::int32_t extrapolate(std::int32_t edge, std::int32_t inner) { return 2 * edge - inner; }

}  // namespace

Erosion::Erosion(const HeightField& field, const Rules& rules, int blockSize, CodePath path)
    : rules_(rules),
      scratch_(field),
      blockSize_(std::clamp(blockSize, 2, kMaxBlock)),
      across_((field.columns() + blockSize_ - 1) / blockSize_),
      down_((field.rows() + blockSize_ - 1) / blockSize_),
      v3_(path == CodePath::automatic && machineHasV3()) {
    const auto blocks = static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_);
    marked_.assign(blocks, 0);
    waiting_.assign(blocks, 0);
    movedNow_.assign(blocks, 0);
    moved_.assign(blocks, 0);
    markedFrom_ = down_;
    wakeAll();
}

const char* Erosion::codePath() const { return v3_ ? "x86-64-v3" : "baseline"; }

void Erosion::wakeAll() {
    active_.resize(marked_.size());
    std::iota(active_.begin(), active_.end(), 0);
}

Rect Erosion::cellsOf(int block) const {
    const int x = block % across_ * blockSize_;
    const int y = block / across_ * blockSize_;
    return Rect{x, y, x + blockSize_, y + blockSize_}.clippedTo(scratch_.bounds());
}

Rect Erosion::blocksAround(const Rect& cells) const {
    return Rect{cells.x0 / blockSize_ - 1, cells.y0 / blockSize_ - 1, (cells.x1 - 1) / blockSize_ + 2,
                (cells.y1 - 1) / blockSize_ + 2}
        .clippedTo({0, 0, across_, down_});
}

void Erosion::mark(const Rect& blocks) {
    markedFrom_ = std::min(markedFrom_, blocks.y0);
    markedTo_ = std::max(markedTo_, blocks.y1);
    for (int y = blocks.y0; y < blocks.y1; ++y) {
        for (int x = blocks.x0; x < blocks.x1; ++x) {
            marked_[static_cast<std::size_t>(y * across_ + x)] = 1;
        }
    }
}

void Erosion::collectMarked() {
    active_.clear();
    for (int block = markedFrom_ * across_; block < markedTo_ * across_; ++block) {
        std::uint8_t& marked = marked_[static_cast<std::size_t>(block)];
        if (marked != 0) {
            active_.push_back(block);
            marked = 0;
        }
    }
    markedFrom_ = down_;
    markedTo_ = 0;
}

void Erosion::touch(const HeightField& field, const Rect& cells) {
    if (cells.empty()) {
        return;
    }
    for (int y = cells.y0; y < cells.y1; ++y) {
        std::copy(field.row(y) + cells.x0, field.row(y) + cells.x1, scratch_.row(y) + cells.x0);
    }
    for (const int block : active_) {
        const int x = block % across_;
        const int y = block / across_;
        mark({x, y, x + 1, y + 1});
    }
    mark(blocksAround(cells));
    collectMarked();
}

std::int64_t Erosion::sweep(HeightField& field, int sweeps, const Obstacle* obstacle) {
    std::int64_t outflow = 0;
    for (int i = 0; i < sweeps && !settled(); ++i) {
        for (const int block : active_) {
            waiting_[static_cast<std::size_t>(block)] = 1;
        }
        for (const int block : active_) {
            if (waiting_[static_cast<std::size_t>(block)] != 0) {
                sweepPatch(field, takePatch(block), obstacle, outflow);
            }
        }
        field.swapHeights(scratch_);
        collectMarked();
    }
    return outflow;
}

Rect Erosion::takePatch(int block) {
    const int x0 = block % across_;
    const int y0 = block / across_;
    const auto waiting = [this](int x, int y) {
        return x >= 0 && x < across_ && waiting_[static_cast<std::size_t>(y * across_ + x)] != 0;
    };
    Rect blocks{x0, y0, x0 + 1, y0};
    const int longest = x0 + kMaxPatch / blockSize_;
    // A column of patches as high as 2048 cells runs through the whole field once for each: a third slower.
    const int highest = std::min(y0 + kMaxBlock / blockSize_, down_);
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

void Erosion::sweepPatch(HeightField& field, const Rect& blocks, const Obstacle* obstacle, std::int64_t& outflow) {
    const Rect cells =
        Rect{blocks.x0 * blockSize_, blocks.y0 * blockSize_, blocks.x1 * blockSize_, blocks.y1 * blockSize_}.clippedTo(
            field.bounds());
    refreshGhosts(field, cells);
    const Rect grown{cells.x0 - 1, cells.y0 - 1, cells.x1 + 1, cells.y1 + 1};
    const bool toolNear = obstacle != nullptr && !obstacle->cells.clippedTo(grown).empty();
    if (toolNear) {
        fillRoom(field, grown, *obstacle);
    }
    const PatchSweep patch{.in = field.row(0),
                           .out = scratch_.row(0),
                           .stride = field.stride(),
                           .cells = cells,
                           .blockSize = blockSize_,
                           .columns = field.columns(),
                           .rows = field.rows(),
                           .threshold = rules_.threshold,
                           .startThreshold = rules_.startThreshold,
                           .n4 = rules_.scheme == Scheme::n4,
                           .openRim = rules_.rim == Rim::open,
                           .room = toolNear ? room_.data() : nullptr,
                           .moved = movedNow_.data() + blocks.y0 * across_ + blocks.x0,
                           .blocksAcross = across_};
    v3_ ? v3::sweepPatch(patch, outflow) : baseline::sweepPatch(patch, outflow);
    markAroundMoved(blocks);
}

void Erosion::markAroundMoved(const Rect& blocks) {
    for (int y = blocks.y0; y < blocks.y1; ++y) {
        for (int x = blocks.x0; x < blocks.x1; ++x) {
            const auto block = static_cast<std::size_t>(y * across_ + x);
            if (movedNow_[block] != 0) {
                moved_[block] = 1;
                mark(Rect{x - 1, y - 1, x + 2, y + 2}.clippedTo({0, 0, across_, down_}));
            }
        }
    }
}

void Erosion::fillRoom(const HeightField& field, const Rect& grown, const Obstacle& obstacle) {
    const int width = grown.x1 - grown.x0;
    room_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(grown.y1 - grown.y0), Obstacle::kFree);
    const Rect shared = obstacle.cells.clippedTo(grown);
    const int obstacleWidth = obstacle.cells.x1 - obstacle.cells.x0;
    for (int y = shared.y0; y < shared.y1; ++y) {
        for (int x = shared.x0; x < shared.x1; ++x) {
            const std::int32_t underside = obstacle.underside[static_cast<std::size_t>(
                (y - obstacle.cells.y0) * obstacleWidth + x - obstacle.cells.x0)];
            if (underside != Obstacle::kFree) {
                // Four faces may each bring a quarter of what fits under the tool.
                room_[static_cast<std::size_t>((y - grown.y0) * width + x - grown.x0)] =
                    std::max(underside - field.height(x, y), 0) / 4;
            }
        }
    }
}

void Erosion::refreshGhosts(HeightField& field, const Rect& cells) const {
    const int columns = field.columns();
    const int rows = field.rows();
    const Rect reach = Rect{cells.x0 - 1, cells.y0 - 1, cells.x1 + 1, cells.y1 + 1}.clippedTo(field.bounds());
    const auto ghostRow = [&](int ghost, int edge, int inner) {
        for (int x = reach.x0; x < reach.x1; ++x) {
            field.setHeight(x, ghost, extrapolate(field.height(x, edge), field.height(x, inner)));
        }
    };
    const auto ghostColumn = [&](int ghost, int edge, int inner) {
        for (int y = reach.y0; y < reach.y1; ++y) {
            field.setHeight(ghost, y, extrapolate(field.height(edge, y), field.height(inner, y)));
        }
    };
    if (cells.y0 == 0) {
        ghostRow(-1, 0, std::min(1, rows - 1));
    }
    if (cells.y1 == rows) {
        ghostRow(rows, rows - 1, std::max(rows - 2, 0));
    }
    if (cells.x0 == 0) {
        ghostColumn(-1, 0, std::min(1, columns - 1));
    }
    if (cells.x1 == columns) {
        ghostColumn(columns, columns - 1, std::max(columns - 2, 0));
    }
}

bool Erosion::copyDiffers(const HeightField& field, const Rect& cells) const {
    for (int y = cells.y0; y < cells.y1; ++y) {
        for (int x = cells.x0; x < cells.x1; ++x) {
            if (field.height(x, y) != scratch_.height(x, y) &&
                !std::binary_search(active_.begin(), active_.end(), y / blockSize_ * across_ + x / blockSize_)) {
                return true;
            }
        }
    }
    return false;
}

std::vector<Rect> Erosion::takeMoved() {
    std::vector<Rect> result;
    for (std::size_t block = 0; block < moved_.size(); ++block) {
        if (moved_[block] != 0) {
            result.push_back(cellsOf(static_cast<int>(block)));
            moved_[block] = 0;
        }
    }
    return result;
}

}  // namespace sand
