// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "base/field_forms.hpp"
#include "lockstep/frame_barrier.hpp"
#include "lockstep/message_limits.hpp"
#include "sand/replica.hpp"

namespace lockstep {

/// The master's decision about sand that differs.
struct Remedy {
    bool goOn = false;     // whether the session continues
    int source = kMaster;  // rank whose state is right
    std::vector<int> odd;  // ranks that take this state

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("go_on", it.goOn);
        visit("source", it.source);
        visit("odd", base::upTo(it.odd, kMostRanks));
    }
    friend bool operator==(const Remedy&, const Remedy&) = default;
};

/// Result of heal() for one rank.
enum class Healing : std::uint8_t {
    ended,   // the session is over
    spared,  // the rank's sand was right
    healed   // the rank's sand has been replaced; everything drawn of it must be drawn again
};

/// Sends the whole state of the remedy's source to the odd ranks, point to point. Then each rank computes its hash
/// again from memory. Call it after findDivergence(). The ranks then meet again at the barrier of the same frame, which
/// shows whether they agree now.
///
/// Only the master's argument `fromMaster` counts. Throws base::FormatError if the received bytes are not a state of
/// this sand. Collective.
[[nodiscard]] Healing heal(FrameBarrier& barrier, sand::Replica& replica, const Remedy& fromMaster = {});

}  // namespace lockstep
