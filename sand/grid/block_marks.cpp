// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/block_marks.hpp"

#include <algorithm>

namespace sand::grid {
namespace {

// Bits of two sides are joined by shifting one to the place of the other.
static_assert(flow::kEast >> 1 == flow::kSouth && flow::kWest << 1 == flow::kSouth);
static_assert(flow::kEast << 1 == flow::kNorth && flow::kWest << 3 == flow::kNorth);

/// Marks the blocks beside flow in three rows of blocks. A block of another row is marked by the block in the same
/// column, if sand flows at the side between them. The next block to the west or east marks it, if sand also flows at
/// its border to this column. Returns whether sand flows anywhere. The loop handles a vector of blocks at a time.
bool markBeside(const std::uint8_t* __restrict flowed, int count, std::uint8_t* __restrict south,
                std::uint8_t* __restrict here, std::uint8_t* __restrict north) {
    std::uint8_t all = 0;
    for (int x = 0; x < count; ++x) {
        const std::uint8_t west = flowed[x - 1], own = flowed[x], east = flowed[x + 1];
        const int corners = (west & west >> 1) | (east & east << 1);
        const int farCorners = (west & west << 1) | (east & east << 3);
        south[x] = static_cast<std::uint8_t>(south[x] | ((own | corners) & flow::kSouth));
        here[x] = static_cast<std::uint8_t>(here[x] | own | (west & flow::kEast) | (east & flow::kWest));
        north[x] = static_cast<std::uint8_t>(north[x] | ((own | farCorners) & flow::kNorth));
        all |= own;
    }
    return all != 0;
}

/// Marks the blocks with flow, and those beyond their eastern and northern faces. Returns whether sand flows anywhere.
bool markChanged(const std::uint8_t* __restrict flowed, int count, std::uint8_t* __restrict here,
                 std::uint8_t* __restrict north) {
    std::uint8_t all = 0;
    for (int x = 0; x < count; ++x) {
        here[x] |= flowed[x] | flowed[x - 1];
        north[x] |= flowed[x];
        all |= flowed[x];
    }
    return all != 0;
}

/// Returns the first place in [from, end) whose mark is set, or is not set; `end` if there is none. Asks eight marks at
/// a time, because long runs of blocks are all marked or all unmarked.
int firstOf(const std::uint8_t* marks, int from, int end, bool isSet) {
    const auto differs = [&](int x) { return (marks[x] != 0) == isSet; };
    constexpr int kTogether = 8;
    while (from + kTogether <= end) {
        int found = 0;
        for (int i = 0; i < kTogether; ++i) {
            found |= differs(from + i) ? 1 : 0;
        }
        if (found != 0) {
            break;
        }
        from += kTogether;
    }
    while (from < end && !differs(from)) {
        ++from;
    }
    return from;
}

}  // namespace

BlockMarks::BlockMarks(int across, int down)
    : across_(across),
      down_(down),
      marks_((static_cast<std::size_t>(across) + 2) * (static_cast<std::size_t>(down) + 2)) {}

void BlockMarks::add(const CellRect& blocks) {
    around_ = around_.joinedWith(blocks);
    for (int y = blocks.y0; y < blocks.y1; ++y) {
        std::fill(row(y) + blocks.x0, row(y) + blocks.x1, std::uint8_t{1});
    }
}

void BlockMarks::addBeside(const CellRect& run, const FlowBits& flowed) {
    const CellRect beside = run.grownBy(1);
    if (markBeside(flowed.row(run.y0) + beside.x0, beside.x1 - beside.x0, row(run.y0 - 1) + beside.x0,
                   row(run.y0) + beside.x0, row(run.y0 + 1) + beside.x0)) {
        around_ = around_.joinedWith(beside.clippedTo({0, 0, across_, down_}));
    }
}

void BlockMarks::addChanged(const CellRect& run, const FlowBits& flowed) {
    const int end = run.x1 + 1;
    if (markChanged(flowed.row(run.y0) + run.x0, end - run.x0, row(run.y0) + run.x0, row(run.y0 + 1) + run.x0)) {
        around_ = around_.joinedWith(CellRect{run.x0, run.y0, end, run.y0 + 2}.clippedTo({0, 0, across_, down_}));
    }
}

std::vector<CellRect> BlockMarks::takeRuns() {
    std::vector<CellRect> runs;
    for (int y = around_.y0; y < around_.y1; ++y) {
        const std::uint8_t* const marks = row(y);
        for (int x = around_.x0; x < around_.x1;) {
            x = firstOf(marks, x, around_.x1, true);
            const int first = x;
            x = firstOf(marks, x, around_.x1, false);
            if (x > first) {
                runs.push_back({first, y, x, y + 1});
            }
        }
        std::fill(row(y) + around_.x0, row(y) + around_.x1, std::uint8_t{0});
    }
    around_ = {};
    return runs;
}

}  // namespace sand::grid
