// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <vector>

#include "sand/model/cell_array.hpp"

namespace sand::grid {

/// Set of blocks of a field, numbered row by row from the south-west. Taking them out takes time in proportion to the
/// rectangle around them, because most blocks of a large field are not in the set. Not thread-safe.
class BlockMarks {
public:
    BlockMarks(int across, int down);

    void add(const CellRect& blocks);  // `blocks` must lie within the field
    [[nodiscard]] bool empty() const { return around_.empty(); }
    /// Calls visit(int block) for each block in ascending order, and empties the set. `visit` must not add blocks.
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
    /// Returns the blocks as runs, each within one row, row by row from the south-west, and empties the set.
    [[nodiscard]] std::vector<CellRect> takeRuns();
    [[nodiscard]] std::size_t bytes() const { return marks_.size(); }

private:
    int across_;
    std::vector<std::uint8_t> marks_;
    CellRect around_;  // contains every mark
};

}  // namespace sand::grid
