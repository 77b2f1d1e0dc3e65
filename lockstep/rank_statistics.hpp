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

/// Arrivals closer than this are a tie [ms]. On a busy core, waking a process takes up to 1 ms, and no rank is blamed
/// for that.
inline constexpr double kTieMs = 1;

/// The rank that came last to one barrier.
struct LastToCome {
    int rank = 0;
    double byMs = 0;  // [ms] after the rank before it; the wall lost this time
};

/// Returns the rank that arrived last. `arrivals` are in order of rank, the master's first. Returns nullopt on a tie,
/// which is usual on a still wall: the last rank came less than kTieMs after the rank before it. Also returns nullopt
/// if there is only one render rank.
[[nodiscard]] std::optional<LastToCome> lastToCome(std::span<const Arrival> arrivals);

/// Statistics of each rank that the master collects at the barrier, frame by frame. Takes at most about 100 KiB per
/// rank.
class RankStatistics {
public:
    explicit RankStatistics(std::size_t ranks /* including the master */);

    /// Adds the arrivals at one barrier, in order of rank, the master's first. Their lastSwap belongs to the frame
    /// before. It is left out if `swapsCount` is false or if this is the first frame.
    void add(std::span<const Arrival> arrivals, bool swapsCount);
    /// Counts a frame that ended the session, because the sand or the view of `ranks` differed.
    void addOdd(std::span<const int> ranks);
    /// Notes that `ranks` differed and were healed in the frame that the next call of add() counts.
    void addHealed(std::span<const int> ranks);

    struct Rank {
        Rank();
        std::uint64_t agreed = 0, differed = 0;  // frames
        std::uint64_t healed = 0;                // times that the rank was healed
        Statistics keptMs;                       // [ms], the wall's wait in each frame in which this rank came last
        Statistics swapUs;                       // [us] after the first swap of the frame
    };
    [[nodiscard]] const std::vector<Rank>& ranks() const { return ranks_; }
    [[nodiscard]] std::uint64_t frames() const { return frames_; }

    /// Returns the swap times of the frame before the last one, in order of rank from 1 [us after the first swap of
    /// that frame]. Empty if they are unknown.
    [[nodiscard]] const std::vector<std::uint32_t>& lastSwapsUs() const { return lastSwapsUs_; }

    /// Returns the rank that stands out in the whole session; nullopt if no rank stands out.
    [[nodiscard]] std::optional<Drag> drag() const;
    /// Returns the rank that stands out in the last kRecent frames; nullopt if no rank stands out.
    [[nodiscard]] std::optional<Drag> recentDrag() const;
    static constexpr std::size_t kRecent = 120;

private:
    std::vector<Rank> ranks_;
    std::vector<int> healedNow_;  // ranks that were healed in the frame that add() counts next
    std::uint64_t frames_ = 0;
    std::vector<std::uint32_t> lastSwapsUs_;
    std::vector<LastToCome> recent_;  // ring buffer; byMs is 0 for a tie
};

}  // namespace lockstep
