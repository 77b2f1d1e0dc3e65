// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lockstep/frame_barrier.hpp"
#include "lockstep/statistics.hpp"
#include "lockstep/wall_figures.hpp"

namespace lockstep {

/// Closer arrivals are a tie [ms]: waking a process takes up to that on a busy core, and must accuse nobody.
inline constexpr double kTieMs = 1;

/// Who came last to one barrier, where that was no tie.
struct LastToCome {
    int rank = 0;
    double byMs = 0;  // so much after the one before [ms]: what the wall would have gained without
};

/// The last of these arrivals, the master's among them. None where it came less than kTieMs after the one before, as
/// all do on a still wall, or where there is nobody to come before it.
[[nodiscard]] std::optional<LastToCome> lastToCome(std::span<const Arrival> arrivals);

/// What the master learns of each rank from the barrier, frame by frame. Memory is bounded: some 100 KiB a rank.
class RankStatistics {
public:
    explicit RankStatistics(std::size_t ranks /* the master's among them */);

    /// After a barrier. `arrivals` by rank, the master's first; their lastSwap is of the frame before, and left out
    /// where `swapsCount` is not set or the frame before was none.
    void add(std::span<const Arrival> arrivals, bool swapsCount);
    /// Ranks whose sand or view was another one, in a frame that ended the session.
    void addOdd(std::span<const int> ranks);
    /// Ranks whose sand was another one in the frame that add() is called for next, and was healed.
    void addHealed(std::span<const int> ranks);

    struct Rank {
        Rank();
        std::uint64_t agreed = 0, differed = 0;  // frames
        std::uint64_t healed = 0;                // of those in which it differed
        Statistics keptMs;                       // frames for which the wall waited, and how long [ms]
        Statistics swapUs;                       // after the first swap of the frame [us]
    };
    [[nodiscard]] const std::vector<Rank>& ranks() const { return ranks_; }
    [[nodiscard]] std::uint64_t frames() const { return frames_; }

    /// Swap times of the last frame but one, by rank from 1: after its first [us]; empty where nothing is known.
    [[nodiscard]] const std::vector<std::uint32_t>& lastSwapsUs() const { return lastSwapsUs_; }

    /// Of the whole session.
    [[nodiscard]] std::optional<Drag> drag() const;
    /// Of the last kRecent frames or so.
    [[nodiscard]] std::optional<Drag> recentDrag() const;
    static constexpr std::size_t kRecent = 120;

private:
    std::vector<Rank> ranks_;
    std::vector<int> healedNow_;  // in the frame that is to be added
    std::uint64_t frames_ = 0;
    std::vector<std::uint32_t> lastSwapsUs_;
    std::vector<LastToCome> recent_;  // a ring; byMs 0 for a tie
};

}  // namespace lockstep
