// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <vector>

#include "sand/model/cell_array.hpp"

namespace sand::grid {

/// A set of blocks out of all blocks of a field, numbered row by row from the south-west. What it costs to take them
/// out grows with the rectangle around them and not with the field: on a large one most hold none. Not thread-safe.
class BlockMarks {
public:
    BlockMarks(int across, int down);

    void add(const CellRect& blocks);  // within all blocks
    [[nodiscard]] bool empty() const { return around_.empty(); }
    /// Calls visit(int block) for each in ascending order, and leaves the set empty. `visit` may add none.
    template <class Visit>
    void takeAll(const Visit& visit) {
        for (int y = around_.y0; y < around_.y1; ++y) {
            for (int block = y * across_ + around_.x0; block < y * across_ + around_.x1; ++block) {
                if (std::uint8_t& mark = marks_[static_cast<std::size_t>(block)]; mark != 0) {
                    mark = 0;
                    visit(block);
                }
            }
        }
        around_ = {};
    }
    /// Returns its blocks as runs, each within one row, row by row from the south-west, and leaves the set empty.
    [[nodiscard]] std::vector<CellRect> takeRuns();
    [[nodiscard]] std::size_t bytes() const { return marks_.size(); }

private:
    int across_;
    std::vector<std::uint8_t> marks_;
    CellRect around_;  // holds every mark
};

}  // namespace sand::grid
