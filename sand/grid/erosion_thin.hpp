// SPDX-License-Identifier: Apache-2.0
// Private to the kernel of the sweeps, which is compiled once per code path: the fluxes of thin sand on rock.
#pragma once

#include "sand/grid/erosion_fluxes.hpp"

namespace sand::grid::SANDWALL_CODE_PATH {

/// Returns whether a cell of a row has sand thinner than `thick` [unit].
inline bool hasThinSand(const std::int32_t* __restrict sand, int count, std::int32_t thick) {
    std::int32_t thin = 0;
    for (int i = 0; i < wholeVectors(count); ++i) {
        thin |= static_cast<std::int32_t>(sand[i] > 0) & static_cast<std::int32_t>(sand[i] < thick);
    }
    return thin != 0;
}

/// Returns whether ThinFluxes may differ from LimitedFluxes: whether a cell of the piece, or one beside it, has less
/// sand than the start threshold. A cell without sand gives none by both.
template <class Law>
bool hasThinSand(const Piece<Law>& piece) {
    const auto thick =
        static_cast<std::int32_t>(std::max(piece.sweep.eastLaw.startThreshold, piece.sweep.northLaw.startThreshold));
    const int from = piece.from - 1, count = piece.count() + 2;
    return hasThinSand(piece.row.south.sand + from, count, thick) ||
           hasThinSand(piece.row.here.sand + from, count, thick) ||
           hasThinSand(piece.row.north.sand + from, count, thick);
}

/// Steps from one run of cells to a parallel one.
struct ThinSteps {
    PieceNumbers counted;  // as in SumsOfSteps [unit]
    PieceNumbers full;     // height difference, at most the start threshold and the room in the lower cell [unit]
    PieceNumbers sand;     // of the upper cell [unit]

    void copy(int from, int to) {
        for (PieceNumbers* const numbers : {&counted, &full, &sand}) {
            (*numbers)[static_cast<unsigned>(to)] = (*numbers)[static_cast<unsigned>(from)];
        }
    }
};

/// Computes the steps from `b` to `a`. `highest` is the start threshold along the steps [unit].
inline void findThinSteps(const LimitedRow a, const LimitedRow b, std::int32_t highest, int count, ThinSteps& steps) {
    std::int32_t* __restrict counted = steps.counted.data();
    std::int32_t* __restrict full = steps.full.data();
    std::int32_t* __restrict sand = steps.sand.data();
    for (int i = 0; i < wholeVectors(count); ++i) {
        const std::int32_t step = std::max(std::min(a.heights[i] - b.heights[i], b.room[i]), -a.room[i]);
        counted[i] = std::max(std::min(step, a.sand[i]), -b.sand[i]);
        full[i] = std::max(std::min(step, highest), -highest);
        sand[i] = a.heights[i] > b.heights[i] ? a.sand[i] : b.sand[i];
    }
}

/// Pairs of steps: step i of `first` and step i + `ahead` of `second`.
struct ThinPairs {
    const ThinSteps& first;
    const ThinSteps& second;
    int ahead;
};

/// Returns what a step counts for a face. `share` is 4 divided by the sand of the face's upper cell.
inline std::int32_t countedFor(float share, std::int32_t counted, std::int32_t full, std::int32_t sand) {
    const auto thin =
        static_cast<std::int32_t>(static_cast<float>(full) * std::min(static_cast<float>(sand) * share, 1.0F));
    return full > 0 ? std::max(counted, thin) : std::min(counted, thin);
}
inline float shareOf(std::int32_t sand) { return 4.0F / static_cast<float>(std::max(sand, 1)); }

/// Adds up the pairs from `from` on, one for each of `count` faces between the cells of `a` and `b`.
///
/// A thin layer on a diagonal slope must slide as on a slope along an axis. So a step counts the height difference up
/// to the start threshold. Its upper cell must have a quarter of the sand of the face's upper cell. With less sand it
/// counts less in proportion. A bare cliff, or dust on one, then makes no stable sand beside it slide.
inline void addUp(const LimitedRow a, const LimitedRow b, const ThinPairs& pairs, int from, int count,
                  std::int32_t* __restrict sums) {
    const std::int32_t* const counted = pairs.first.counted.data() + from;
    const std::int32_t* const full = pairs.first.full.data() + from;
    const std::int32_t* const sand = pairs.first.sand.data() + from;
    const std::int32_t* const countedNext = pairs.second.counted.data() + from + pairs.ahead;
    const std::int32_t* const fullNext = pairs.second.full.data() + from + pairs.ahead;
    const std::int32_t* const sandNext = pairs.second.sand.data() + from + pairs.ahead;
    for (int i = 0; i < wholeVectors(count); ++i) {
        const float share = shareOf(a.heights[i] > b.heights[i] ? a.sand[i] : b.sand[i]);
        sums[i] = countedFor(share, counted[i], full[i], sand[i]) +
                  countedFor(share, countedNext[i], fullNext[i], sandNext[i]);
    }
}

/// Returns the sum of pair i for a face over the rim, whose upper cell has `sand` [unit].
inline std::int32_t sumAtRim(const ThinPairs& pairs, std::int32_t sand, int i) {
    const auto here = static_cast<unsigned>(i), next = static_cast<unsigned>(i + pairs.ahead);
    const float share = shareOf(sand);
    return countedFor(share, pairs.first.counted[here], pairs.first.full[here], pairs.first.sand[here]) +
           countedFor(share, pairs.second.counted[next], pairs.second.full[next], pairs.second.sand[next]);
}

/// The fluxes of a piece on ground. They are those of LimitedFluxes, except that a step on thin sand counts more for a
/// face that has little sand to give.
template <class Law>
class ThinFluxes {
public:
    explicit ThinFluxes(const Piece<Law>& piece)
        : piece_(piece),
          south_(piece.row.south.movedBy(piece.from)),
          here_(piece.row.here.movedBy(piece.from)),
          north_(piece.row.north.movedBy(piece.from)),
          rim_(piece.row, piece.row.here.sand) {}

    /// Returns the outflow over an open rim [unit · cell].
    std::int64_t compute() {
        northFluxes();
        eastFluxes();
        return rim_.outflow();
    }

private:
    void northFluxes() {
        const int y = piece_.row.y, count = piece_.count();
        findEastwards(here_, first_);
        const ThinPairs pairs{first_, first_, 1};
        const auto riseEast = [&](int i) { return sumAtRim(pairs, here_.sand[i], i); };
        if (piece_.isFirstRow()) {
            piece_.rimNorth(rim_, -1, riseEast);
        }
        if (piece_.isLastRow()) {
            piece_.rimNorth(rim_, y, riseEast);
            return;
        }
        findEastwards(north_, second_);
        addUp(here_, north_, pairs, 0, count, behind_.data());
        addUp(here_, north_, ThinPairs{second_, second_, 1}, 0, count, ahead_.data());
        fluxesBetween(piece_.northLaw, here_.heights, north_.heights, behind_.data(), ahead_.data(),
                      piece_.slidingInNorth(), count, piece_.north(y));
        limitFluxes(here_, north_, count, piece_.north(y));
    }

    void eastFluxes() {
        const int count = piece_.count();
        const LimitedRow next = here_.movedBy(1);
        const std::int32_t last = piece_.east()[count - 1];
        findNorthwards();
        const ThinPairs pairs{first_, second_, 0};
        addUp(here_, next, pairs, 0, count, behind_.data());
        addUp(here_, next, pairs, 1, count, ahead_.data());
        fluxesBetween(piece_.eastLaw, here_.heights, next.heights, behind_.data(), ahead_.data(),
                      piece_.slidingInEast(), count, piece_.east());
        limitFluxes(here_, next, count, piece_.east());
        piece_.rimEastAndWest(rim_, last, [&](int i) { return sumAtRim(pairs, here_.sand[i], i); });
    }

    /// Computes the step to each cell of a row, and to one more, from the west. Beyond the rim the last step continues.
    void findEastwards(const LimitedRow& row, ThinSteps& steps) const {
        const int count = piece_.count();
        findThinSteps(row, row.movedBy(-1), static_cast<std::int32_t>(piece_.sweep.eastLaw.startThreshold),
                      wholeVectors(count) + 2, steps);
        if (piece_.from == 0) {
            steps.copy(1, 0);
        }
        if (piece_.end == piece_.sweep.columns) {
            steps.copy(count - 1, count);
        }
    }
    /// Computes the step to each cell of the row, and to one more, from the south (first_), and from each to the north
    /// (second_). Beyond the rim the last step continues.
    void findNorthwards() {
        const auto highest = static_cast<std::int32_t>(piece_.sweep.northLaw.startThreshold);
        const int count = wholeVectors(piece_.count()) + 2;  // addUp() reads two numbers beyond its vectors
        const LimitedRow &south = piece_.isFirstRow() ? here_ : south_, &here = piece_.isFirstRow() ? north_ : here_;
        findThinSteps(here, south, highest, count, first_);
        const LimitedRow &above = piece_.isLastRow() ? here_ : north_, &below = piece_.isLastRow() ? south_ : here_;
        findThinSteps(above, below, highest, count, second_);
    }

    const Piece<Law>& piece_;
    LimitedRow south_, here_, north_;
    RimFluxes<Law> rim_;
    ThinSteps first_, second_;     // uninitialised, because a piece may be short
    PieceNumbers behind_, ahead_;  // [unit], sums of two steps along each face
};

}  // namespace sand::grid::SANDWALL_CODE_PATH
