// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/field_forms.hpp"
#include "lockstep/message_limits.hpp"

namespace lockstep {

/// A rank for which the wall waits far more often than for any other.
struct Drag {
    int rank = 0;       // 0: the master
    double share = 0;   // share of the frames in which the wall waited for it
    double keptMs = 0;  // [ms], mean wait in these frames
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("rank", base::varint(it.rank));
        visit("share", it.share);
        visit("wall_waited_ms", it.keptMs);
    }
    friend bool operator==(const Drag&, const Drag&) = default;
};

/// Figures of the whole wall, which a render rank cannot measure. They cover all frames before the present one.
struct WallFigures {
    double frameMs = 0;                // [ms] from swap to swap; 0 before the second swap
    std::optional<Drag> slowest;       // in the last frames; nullopt if no rank stands out
    std::uint64_t agreed = 0;          // frames in which all hashes were equal
    std::uint64_t divergences = 0;     // frames in which hashes differed at first
    std::uint64_t healed = 0;          // times that a rank was healed
    std::uint64_t unplaced = 0;        // steps whose sand no cell could take
    std::int32_t sweepsOwed = 0;       // that the tool waits for
    std::optional<double> slowMotion;  // time of the hand that has passed, divided by that which is in steps
    std::vector<std::uint32_t> dark;   // ranks with an output that no monitor shows
    std::vector<std::uint32_t> swaps;  // [us] after a frame's first swap, by rank from 1; empty if unknown

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("frame_ms", it.frameMs);
        visit("slowest", it.slowest);
        visit("agreed", base::varint(it.agreed));
        visit("divergences", base::varint(it.divergences));
        visit("healed", base::varint(it.healed));
        visit("steps_unplaced", base::varint(it.unplaced));
        visit("sweeps_owed", base::varint(it.sweepsOwed));
        visit("slow_motion", it.slowMotion);
        visit("dark", base::upTo(it.dark, kMostRanks));
        visit("swaps_us", base::upTo(it.swaps, kMostRanks));
    }
    friend bool operator==(const WallFigures&, const WallFigures&) = default;
};

}  // namespace lockstep
