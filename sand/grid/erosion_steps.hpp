// SPDX-License-Identifier: Apache-2.0
// The steps along a face, as the slope of the face counts them beside a tool and on rock. docs/sand.md has the rules
// and the reason for each. Private to the kernel of the sweeps, which is compiled once per code path.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "sand/grid/displacement.hpp"
#include "sand/grid/erosion_kernel.hpp"

namespace sand::grid::SANDWALL_CODE_PATH {

/// [cell], longest piece of a row. The later loops over a piece find its numbers in the first-level cache.
inline constexpr int kPiece = 256;

/// One number for each cell of a piece and one more on each side. It is left uninitialised, because a piece may be
/// short.
using PieceNumbers = std::array<std::int32_t, kPiece + 2 * kVector>;

/// Returns a number of cells that are whole vectors and at least `count`. A loop over them has no remainder, which
/// would take longer than the rest of a short piece. Numbers beyond `count` have no meaning.
constexpr int wholeVectors(int count) { return (count + kVector - 1) / kVector * kVector; }

/// A row of cells as limited fluxes see it. The pointers are at the first cell of the piece.
struct LimitedRow {
    const std::int32_t* heights;  // [unit]
    const std::int32_t* sand;     // thickness of the sand [unit]; null without ground
    const std::int32_t* room;  // free height below the tool [unit]; without a limit, more than any two heights differ

    [[nodiscard]] LimitedRow movedBy(std::ptrdiff_t cells) const {
        return {heights + cells, sand == nullptr ? nullptr : sand + cells, room + cells};
    }
};

/// Writes what fits below the tool in each cell of a row [unit].
inline void roomBelow(const std::int32_t* __restrict undersides, const std::int32_t* __restrict heights, int count,
                      std::int32_t* __restrict room) {
    for (int i = 0; i < wholeVectors(count); ++i) {
        room[i] = std::max(undersides[i] - heights[i], 0);
    }
}

/// Returns what the step from cell i of `below` to cell k of `above` counts [unit]. It is at most the room in the lower
/// of the two cells, and on ground at most the sand of the upper one.
template <bool kOnGround>
std::int32_t countedStep(const LimitedRow& above, int k, const LimitedRow& below, int i) {
    const std::int32_t most = kOnGround ? std::min(below.room[i], above.sand[k]) : below.room[i];
    const std::int32_t least = kOnGround ? std::min(above.room[k], below.sand[i]) : above.room[k];
    return std::max(std::min(above.heights[k] - below.heights[i], most), -least);
}

/// Writes the steps between two rows.
template <bool kOnGround>
void findSteps(const LimitedRow above, const LimitedRow below, int count, std::int32_t* __restrict steps) {
    for (int i = 0; i < wholeVectors(count); ++i) {
        steps[i] = countedStep<kOnGround>(above, i, below, i);
    }
}

/// Writes the sum of the two steps along the row at each cell, from its western neighbour and to its eastern one.
template <bool kOnGround>
void addStepsAlong(const LimitedRow row, int count, std::int32_t* __restrict sums) {
    for (int i = 0; i < wholeVectors(count); ++i) {
        sums[i] = countedStep<kOnGround>(row, i, row, i - 1) + countedStep<kOnGround>(row, i + 1, row, i);
    }
}

inline void addRows(const std::int32_t* __restrict a, const std::int32_t* __restrict b, int count,
                    std::int32_t* __restrict sums) {
    for (int i = 0; i < wholeVectors(count); ++i) {
        sums[i] = a[i] + b[i];
    }
}

/// The sides on which a piece ends at the rim of the field. Beyond the rim the last step continues.
struct AtRim {
    bool west, east, south, north;
};

/// The sums of two steps along each face of a piece. They go over the rows of cells from south to north, and each sum
/// is computed once.
template <bool kOnGround>
class SumsOfSteps {
public:
    explicit SumsOfSteps(int count) : count_(count) {}

    /// Begins with the row `here`.
    void begin(const LimitedRow& south, const LimitedRow& here, const AtRim& rim) {
        if (!rim.south || rim.north) {  // a field of one row has no other steps than those to its ghosts
            findSteps<kOnGround>(here, south, count_ + 1, toSouth());
        }
        addAlong(here, rim, alongRow_[now_]);
    }
    /// Computes the sums for the faces of the row `here`.
    void compute(const LimitedRow& here, const LimitedRow& north, const AtRim& rim) {
        if (!rim.north || rim.south) {
            findSteps<kOnGround>(north, here, count_ + 1, toNorth());
            addAlong(north, rim, alongRow_[now_ ^ 1U]);
        }
        addRows(rim.south ? toNorth() : toSouth(), rim.north ? toSouth() : toNorth(), count_ + 1, alongEast_.data());
    }
    /// Begins the next row.
    void next() { now_ ^= 1U; }

    // Each sum is that of one cell [unit]. A face adds up the sums of its two cells.
    /// Along the eastern faces: the cells of the piece and one more in the east.
    [[nodiscard]] const std::int32_t* alongEast() const { return alongEast_.data(); }
    /// Along the northern faces: the cells of the row.
    [[nodiscard]] const std::int32_t* alongNorth() const { return alongRow_[now_].data(); }
    /// Along the northern faces: the cells of the row in the north.
    [[nodiscard]] const std::int32_t* alongNorthAhead() const { return alongRow_[now_ ^ 1U].data(); }

private:
    [[nodiscard]] std::int32_t* toSouth() { return steps_[now_].data(); }
    [[nodiscard]] std::int32_t* toNorth() { return steps_[now_ ^ 1U].data(); }

    void addAlong(const LimitedRow& row, const AtRim& rim, PieceNumbers& sums) const {
        addStepsAlong<kOnGround>(row, count_, sums.data());
        if (rim.east) {
            sums[static_cast<unsigned>(count_ - 1)] = 2 * countedStep<kOnGround>(row, count_ - 1, row, count_ - 2);
        }
        if (rim.west) {
            sums[0] = 2 * countedStep<kOnGround>(row, 1, row, 0);
        }
    }

    int count_;
    unsigned now_ = 0;
    std::array<PieceNumbers, 2> steps_, alongRow_;  // uninitialised, because a piece may be short
    PieceNumbers alongEast_;
};

}  // namespace sand::grid::SANDWALL_CODE_PATH
