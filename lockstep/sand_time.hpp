// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/clock.hpp"
#include "sand/replica.hpp"

namespace lockstep {

/// Wall time that a rank spends on the sand of a frame [ns].
struct SandTime {
    std::int64_t dragNs = 0;   // movements and edits
    std::int64_t sweepNs = 0;  // sweeps
    std::int64_t hashNs = 0;   // audit and hash

    SandTime& operator+=(const SandTime& other) {
        dragNs += other.dragNs;
        sweepNs += other.sweepNs;
        hashNs += other.hashNs;
        return *this;
    }
};

/// Applies `step`, and returns the time that it took.
inline SandTime applyTimed(sand::Replica& replica, const sand::Step& step) {
    const std::int64_t begin = host::monotonicNs();
    std::int64_t moved = 0;  // 0: the step had no sweeps
    replica.apply(step, [&moved] { moved = host::monotonicNs(); });
    const std::int64_t end = host::monotonicNs();
    return {(moved == 0 ? end : moved) - begin, moved == 0 ? 0 : end - moved, 0};
}

}  // namespace lockstep
