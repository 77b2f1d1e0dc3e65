// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <vector>

#include "sand/model/cell_array.hpp"

namespace sand::grid {

/// Bits that record where in a block sand flows. A block owns the eastern and northern faces of its cells. A face
/// changes two heights. The fluxes of a block depend on its heights and on those one cell around it. If no sand flows
/// near a side of a block, the block beyond that side therefore does not change.
namespace flow {
inline constexpr int kSomewhere = 1;
inline constexpr int kWest = 2, kSouth = 4;   // in the block's first column or row
inline constexpr int kEast = 8, kNorth = 16;  // in the block's last two columns or rows
}  // namespace flow

/// One byte with the bits of `flow` per block of a field. All bytes are 0 at first. Not thread-safe.
class FlowBits {
public:
    FlowBits(int across, int down)
        : stride_(across + 2 * kMargin), bits_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(down)) {}

    /// Returns a pointer to block 0 of a row of blocks. Two more blocks at each end are always 0, so that BlockMarks
    /// need not ask where a row ends.
    [[nodiscard]] std::uint8_t* row(int y) { return bits_.data() + y * stride_ + kMargin; }
    [[nodiscard]] const std::uint8_t* row(int y) const { return bits_.data() + y * stride_ + kMargin; }
    [[nodiscard]] std::ptrdiff_t stride() const { return stride_; }  // [block], from one row to the next
    [[nodiscard]] std::size_t bytes() const { return bits_.size(); }

private:
    static constexpr int kMargin = 2;  // [block]

    std::ptrdiff_t stride_;
    std::vector<std::uint8_t> bits_;
};

/// Set of blocks of a field, numbered row by row from the south-west. Taking them out takes time in proportion to the
/// rectangle around them, because most blocks of a large field are not in the set. Not thread-safe.
class BlockMarks {
public:
    BlockMarks(int across, int down);

    void add(const CellRect& blocks);  // `blocks` must lie within the field
    /// Adds the blocks that the next sweep must visit because sand flowed in a run of blocks within one row.
    void addBeside(const CellRect& run, const FlowBits& flowed);
    /// Adds the blocks whose heights may have changed because sand flowed in a run of blocks within one row.
    void addChanged(const CellRect& run, const FlowBits& flowed);

    [[nodiscard]] bool empty() const { return around_.empty(); }
    /// Calls visit(int block) for each block in ascending order, and empties the set. `visit` must not add blocks.
    template <class Visit>
    void takeAll(const Visit& visit) {
        for (int y = around_.y0; y < around_.y1; ++y) {
            std::uint8_t* const marks = row(y);
            for (int x = around_.x0; x < around_.x1; ++x) {
                if (marks[x] != 0) {
                    marks[x] = 0;
                    visit(y * across_ + x);
                }
            }
        }
        around_ = {};
    }
    /// Returns the blocks as runs, each within one row, row by row from the south-west, and empties the set.
    [[nodiscard]] std::vector<CellRect> takeRuns();
    [[nodiscard]] std::size_t bytes() const { return marks_.size(); }

private:
    /// Returns the marks of a row of blocks. Rows -1 and `down`, columns -1 and `across` lie outside the field. They
    /// take marks that are never read. So addBeside() adds marks beyond the end of a run without a check.
    [[nodiscard]] std::uint8_t* row(int y) {
        return marks_.data() + (y + std::ptrdiff_t{1}) * (across_ + std::ptrdiff_t{2}) + 1;
    }

    int across_, down_;
    std::vector<std::uint8_t> marks_;  // not 0 if the block is in the set
    CellRect around_;                  // contains every mark within the field
};

}  // namespace sand::grid
