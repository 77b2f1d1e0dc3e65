// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/block_marks.hpp"

#include <algorithm>

namespace sand::grid {

BlockMarks::BlockMarks(int across, int down)
    : across_(across), marks_(static_cast<std::size_t>(across) * static_cast<std::size_t>(down)) {}

void BlockMarks::add(const CellRect& blocks) {
    around_ = around_.joinedWith(blocks);
    for (int y = blocks.y0; y < blocks.y1; ++y) {
        std::fill_n(&marks_[static_cast<std::size_t>(y * across_ + blocks.x0)], blocks.x1 - blocks.x0, std::uint8_t{1});
    }
}

std::vector<CellRect> BlockMarks::takeRuns() {
    std::vector<CellRect> runs;
    takeAll([&](int block) {
        const int x = block % across_;
        const int y = block / across_;
        if (!runs.empty() && runs.back().y0 == y && runs.back().x1 == x) {
            ++runs.back().x1;
        } else {
            runs.push_back({x, y, x + 1, y + 1});
        }
    });
    return runs;
}

}  // namespace sand::grid
