// SPDX-License-Identifier: Apache-2.0
// Private to the kernel of the sweeps, which is compiled once per code path: the fluxes of a piece of one cell row.
#pragma once

#include <array>

#include "sand/grid/erosion_loops.hpp"
#include "sand/grid/erosion_steps.hpp"
#if defined(__wasm_simd128__)
#include "sand/grid/erosion_loops_wasm.hpp"
#endif

namespace sand::grid::SANDWALL_CODE_PATH {

/// One cell row of a run, with the rows beside it. All pointers are at column 0.
struct CellRow {
    int y;
    LimitedRow south, here, north;          // before the sweep. Beside a tool, `room` has the undersides instead.
    const Sliding *sliding, *slidingAbove;  // of this row and of the next one; with a band
    std::int32_t* oldAbove;                 // receives the heights of the next row, see RowBuffers
};

/// Fluxes over an open rim, where sand falls to height 0 and never comes back.
template <class Law>
class RimFluxes {
public:
    RimFluxes(const CellRow& row, const std::int32_t* sand) : row_(row), sand_(sand) {}

    /// Returns the flux from the cell in `column`. `rise` is the difference along the rim beside it [unit].
    std::int32_t from(const Law& law, int column, std::int32_t rise, std::int32_t last) {
        const std::int32_t slides = Law::kBand ? row_.sliding[column] : 0;
        const float along = 2 * static_cast<float>(rise);
        std::int32_t flux = std::max(law(row_.here.heights[column], along, last, slides), 0);
        if (sand_ != nullptr) {
            flux = std::min(flux, sand_[column] / 4);
        }
        outflow_ += flux;
        return flux;
    }
    [[nodiscard]] std::int64_t outflow() const { return outflow_; }

private:
    const CellRow& row_;
    const std::int32_t* sand_;  // null without ground
    std::int64_t outflow_ = 0;  // [unit · cell]
};

/// The arguments of the fluxes of a piece. It has cells [from, end) of a row.
template <class Law>
struct Piece {
    const Sweep& sweep;
    const Law &eastLaw, &northLaw;
    const CellRow& row;
    int from, end;

    [[nodiscard]] int count() const { return end - from; }
    [[nodiscard]] bool isFirstRow() const { return row.y == 0; }
    [[nodiscard]] bool isLastRow() const { return row.y == sweep.rows - 1; }
    [[nodiscard]] std::int32_t* east() const { return sweep.east + row.y * sweep.fluxStride + from; }
    [[nodiscard]] std::int32_t* north(int y) const { return sweep.north + y * sweep.fluxStride + from; }
    [[nodiscard]] SlidingPair slidingInEast() const { return {row.sliding + from, row.sliding + from + 1}; }
    [[nodiscard]] SlidingPair slidingInNorth() const { return {row.sliding + from, row.slidingAbove + from}; }

    /// Computes the fluxes over the southern rim (y = -1) or the northern rim. `riseEast` returns the difference along
    /// the rim beside cell i of the piece.
    template <class Rise>
    void rimNorth(RimFluxes<Law>& rim, int y, const Rise& riseEast) const {
        std::int32_t* const flux = north(y);
        for (int i = 0; sweep.openRim && i < count(); ++i) {
            const std::int32_t rise = riseEast(i);
            flux[i] =
                y < 0 ? -rim.from(northLaw, from + i, rise, -flux[i]) : rim.from(northLaw, from + i, rise, flux[i]);
        }
    }
    /// Computes the fluxes over the western and the eastern rim. `last` is the last sweep's flux through the face at
    /// the eastern end of the piece.
    template <class Rise>
    void rimEastAndWest(RimFluxes<Law>& rim, std::int32_t last, const Rise& riseNorth) const {
        std::int32_t* const flux = east();
        if (sweep.openRim && from == 0) {
            flux[-1] = -rim.from(eastLaw, 0, riseNorth(0), -flux[-1]);
        }
        if (end == sweep.columns) {
            const int i = count() - 1;
            flux[i] = sweep.openRim ? rim.from(eastLaw, end - 1, riseNorth(i), last) : 0;
        }
    }
};

/// Computes the fluxes of cells through their eastern and northern faces and over the rim, without limits. Returns the
/// outflow over an open rim [unit · cell].
template <class Law>
std::int64_t freeFluxes(const Piece<Law>& piece) {
    const CellRow& row = piece.row;
    const std::int32_t* const south = row.south.heights + piece.from;
    const std::int32_t* const here = row.here.heights + piece.from;
    const std::int32_t* const north = row.north.heights + piece.from;
    const auto riseEast = [here](int i) { return here[i + 1] - here[i - 1]; };
    RimFluxes<Law> rim(row, nullptr);
    if (piece.isFirstRow()) {
        piece.rimNorth(rim, -1, riseEast);
    }
    // The face at the eastern rim is computed like the others and corrected afterwards. A row whose number of faces is
    // a multiple of eight then has no remainder, which would take longer than all other faces.
    const std::int32_t lastInEast = piece.east()[piece.count() - 1];
    if (piece.isLastRow()) {
        piece.rimNorth(rim, row.y, riseEast);
        eastwards(piece.eastLaw, south, here, north, piece.slidingInEast(), piece.count(), piece.east());
    } else {
        eastwardsAndNorthwards(piece.eastLaw, piece.northLaw, south, here, north, piece.slidingInNorth(), piece.count(),
                               piece.east(), piece.north(row.y), row.oldAbove + piece.from);
    }
    piece.rimEastAndWest(rim, lastInEast, [=](int i) { return north[i] - south[i]; });
    return rim.outflow();
}

/// Limits the fluxes from the cells of a row to those of `receiver`, and back.
inline void limitFluxes(const LimitedRow& row, const LimitedRow& receiver, int count, std::int32_t* flux) {
    limitToQuarter(receiver.room, row.room, count, flux);
    if (row.sand != nullptr) {
        limitToQuarter(row.sand, receiver.sand, count, flux);
    }
}

/// Computes the fluxes of cells with the limits of the tool, or of the ground and the tool. The slope along a face
/// counts what its steps count. Goes over rows of cells from south to north.
template <class Law, bool kOnGround>
class LimitedFluxes {
public:
    explicit LimitedFluxes(int count) : sums_(count) {}

    /// Begins with the row of a piece.
    void begin(const Piece<Law>& piece) {
        if constexpr (!kOnGround) {
            findRoom(piece, piece.row.south, 0);
            findRoom(piece, piece.row.here, 1);
        }
        sums_.begin(rowOf(piece, piece.row.south, 0), rowOf(piece, piece.row.here, 1), atRim(piece));
    }

    /// Computes the fluxes of the piece. The next call is for the row in the north. Returns the outflow over an open
    /// rim [unit · cell].
    std::int64_t compute(const Piece<Law>& piece) {
        if constexpr (!kOnGround) {
            findRoom(piece, piece.row.north, 2);
        }
        const LimitedRow here = rowOf(piece, piece.row.here, 1), north = rowOf(piece, piece.row.north, 2);
        sums_.compute(here, north, atRim(piece));
        RimFluxes<Law> rim(piece.row, piece.row.here.sand);
        northFluxes(piece, rim, here, north);
        eastFluxes(piece, rim, here);
        sums_.next();
        if constexpr (!kOnGround) {
            here_ = here_ == 2 ? 0 : here_ + 1;
        }
        return rim.outflow();
    }

private:
    static AtRim atRim(const Piece<Law>& piece) {
        return {piece.from == 0, piece.end == piece.sweep.columns, piece.isFirstRow(), piece.isLastRow()};
    }
    /// Returns the room in the row that is `ahead` of the southern one.
    std::int32_t* roomOf(unsigned ahead) { return room_[(here_ + ahead) % 3].data(); }
    void findRoom(const Piece<Law>& piece, const LimitedRow& row, unsigned ahead) {
        const int cells = piece.count() + 2;
        roomBelow(row.room + piece.from - 1, row.heights + piece.from - 1, cells, roomOf(ahead));
        std::fill_n(roomOf(ahead) + wholeVectors(cells), kVector, 0);  // loops over whole vectors read these numbers
    }
    LimitedRow rowOf(const Piece<Law>& piece, const LimitedRow& row, unsigned ahead) {
        if constexpr (kOnGround) {
            return row.movedBy(piece.from);
        }
        return {row.heights + piece.from, nullptr, roomOf(ahead) + 1};
    }

    void northFluxes(const Piece<Law>& piece, RimFluxes<Law>& rim, const LimitedRow& here, const LimitedRow& north) {
        const int y = piece.row.y;
        const auto riseEast = [this](int i) { return sums_.alongNorth()[i]; };
        if (piece.isFirstRow()) {
            piece.rimNorth(rim, -1, riseEast);
        }
        if (piece.isLastRow()) {
            piece.rimNorth(rim, y, riseEast);
            return;
        }
        fluxesBetween(piece.northLaw, here.heights, north.heights, sums_.alongNorth(), sums_.alongNorthAhead(),
                      piece.slidingInNorth(), piece.count(), piece.north(y));
        limitFluxes(here, north, piece.count(), piece.north(y));
    }

    void eastFluxes(const Piece<Law>& piece, RimFluxes<Law>& rim, const LimitedRow& here) {
        const LimitedRow next = here.movedBy(1);
        const std::int32_t* const sums = sums_.alongEast();
        const std::int32_t last = piece.east()[piece.count() - 1];
        fluxesBetween(piece.eastLaw, here.heights, next.heights, sums, sums + 1, piece.slidingInEast(), piece.count(),
                      piece.east());
        limitFluxes(here, next, piece.count(), piece.east());
        piece.rimEastAndWest(rim, last, [=](int i) { return sums[i]; });
    }

    SumsOfSteps<kOnGround> sums_;
    std::array<PieceNumbers, kOnGround ? 0 : 3> room_;  // of three rows; uninitialised, because a piece may be short
    unsigned here_ = 0;                                 // index of the southern row
};

/// Shortens cells [from, end) of row y so that the tool limits all of them or none. Returns whether it limits them.
/// `held` is null without a tool.
inline bool cutToHeld(const HeldFaces* held, int y, int from, int& end) {
    const Obstacle::Columns columns = held == nullptr ? Obstacle::Columns{0, 0} : held->columns(y);
    if (columns.x0 >= columns.x1 || from >= columns.x1) {
        return false;
    }
    const bool limited = from >= columns.x0;
    end = std::min(end, limited ? columns.x1 : columns.x0);
    return limited;
}

/// Adds the undersides of the tool to a row of cells, whose faces it limits.
inline void addUndersides(const HeldFaces& held, CellRow& row) {
    row.south.room = held.undersides(row.y - 1);
    row.here.room = held.undersides(row.y);
    row.north.room = held.undersides(row.y + 1);
}

}  // namespace sand::grid::SANDWALL_CODE_PATH
