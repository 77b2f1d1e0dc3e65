// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/resting_blocks.hpp"

#include <algorithm>
#include <cstddef>

namespace sand::grid {
namespace {

/// Adds to `steep` where two parallel runs of heights differ by more than `most`. Differences fit 32 bits, because no
/// height is beyond kMaxHeight.
void compare(const std::int32_t* __restrict heights, const std::int32_t* __restrict next, int count, std::int32_t most,
             std::uint32_t* __restrict steep) {
    for (int i = 0; i < count; ++i) {
        const std::int32_t rise = next[i] - heights[i];
        steep[i] |= static_cast<std::uint32_t>(rise > most) | static_cast<std::uint32_t>(-rise > most);
    }
}

}  // namespace

RestingBlocks::RestingBlocks(const HeightField& field, const Rules& rules, int blockSize,
                             std::vector<std::uint32_t>& storage)
    : field_(field), blockSize_(blockSize), openRim_(rules.rim == Rim::open), steep_(storage) {
    steep_.resize(static_cast<std::size_t>(field.columns()));
    // A little less than 1/√2, for the rounding of the law's floats.
    const double most = 0.7 * rules.tuning.threshold;
    const auto within = [](double rise) { return static_cast<std::int32_t>(std::min(rise, 2.0 * kMaxHeight)); };
    mostEast_ = within(most);
    mostNorth_ = within(most * rules.aspect / kUnitsPerCell);
}

void RestingBlocks::markSteep(const CellRect& cells) {
    std::fill(steep_.begin() + cells.x0, steep_.begin() + cells.x1, 0U);
    std::uint32_t* const steep = steep_.data() + cells.x0;
    for (int y = cells.y0; y < cells.y1; ++y) {
        const std::int32_t* const row = field_.row(y) + cells.x0;
        compare(row, row + 1, cells.x1 - cells.x0 - 1, mostEast_, steep);
        if (y + 1 < cells.y1) {
            compare(row, field_.row(y + 1) + cells.x0, cells.x1 - cells.x0, mostNorth_, steep);
        }
    }
}

void RestingBlocks::appendOthers(const CellRect& run, std::vector<CellRect>& others) {
    const CellRect field = field_.bounds();
    const auto cellsOf = [&](int x0, int x1) {
        return CellRect{x0 * blockSize_, run.y0 * blockSize_, x1 * blockSize_, run.y1 * blockSize_}.clippedTo(field);
    };
    markSteep(cellsOf(run.x0, run.x1).grownBy(1).clippedTo(field));
    const bool atRim = openRim_ && (run.y0 == 0 || cellsOf(run.x0, run.x1).y1 == field.y1);
    const auto rests = [&](int x) {
        const CellRect cells = cellsOf(x, x + 1);
        if (atRim || (openRim_ && (cells.x0 == 0 || cells.x1 == field.x1))) {
            return false;
        }
        const CellRect around = cells.grownBy(1).clippedTo(field);
        return std::all_of(steep_.begin() + around.x0, steep_.begin() + around.x1,
                           [](std::uint32_t steep) { return steep == 0; });
    };
    for (int x = run.x0; x < run.x1;) {
        if (rests(x)) {
            ++x;
            continue;
        }
        const int first = x;
        while (x < run.x1 && !rests(x)) {
            ++x;
        }
        others.push_back({first, run.y0, x, run.y1});
    }
}

}  // namespace sand::grid
