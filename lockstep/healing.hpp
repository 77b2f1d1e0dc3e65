// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "lockstep/frame_barrier.hpp"
#include "sand/replica.hpp"

namespace lockstep {

/// What the master has decided to do about sand that differs.
struct Remedy {
    bool goOn = false;     // else the session ends here
    int source = kMaster;  // whose state is right
    std::vector<int> odd;  // who takes it

    [[nodiscard]] base::Bytes encode() const;
    /// Throws base::FormatError when cut short.
    static Remedy decode(std::span<const std::uint8_t> bytes);
    friend bool operator==(const Remedy&, const Remedy&) = default;
};

/// What that was to one rank.
enum class Healing : std::uint8_t {
    ended,   // the session is over
    spared,  // its sand was right
    healed   // its sand is another one now, and all that was drawn of it is void
};

/// Collective, after findDivergence(): the whole state of the remedy's source goes to the odd ranks, point to point.
/// Only the master gives a remedy. Everyone's hash is then computed afresh from memory; whether all agree is seen when
/// they meet at the barrier of the same frame once more. Throws base::FormatError when a state is none.
[[nodiscard]] Healing heal(FrameBarrier& barrier, sand::Replica& terrain, const Remedy& fromMaster = {});

}  // namespace lockstep
