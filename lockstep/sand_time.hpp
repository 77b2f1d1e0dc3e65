// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/clock.hpp"
#include "sand/replica.hpp"

namespace lockstep {

/// Wall time that a rank spends on the sand of a frame [ns].
struct SandTime {
    std::int64_t dragNs = 0;   // movements and edits
    std::int64_t phaseNs = 0;  // coarse phases
    std::int64_t sweepNs = 0;  // sweeps
    std::int64_t hashNs = 0;   // audit and hash

    SandTime& operator+=(const SandTime& other) {
        dragNs += other.dragNs;
        phaseNs += other.phaseNs;
        sweepNs += other.sweepNs;
        hashNs += other.hashNs;
        return *this;
    }
};

/// Applies `step`, and returns the time that it took.
inline SandTime applyTimed(sand::Replica& replica, const sand::Step& step) {
    const std::int64_t begin = host::monotonicNs();
    SandTime time;
    std::int64_t last = begin;
    bool sweeps = false;
    replica.apply(step, [&](sand::StepPart ended) {
        const std::int64_t now = host::monotonicNs();
        (ended == sand::StepPart::movement ? time.dragNs : time.phaseNs) = now - last;
        last = now;
        sweeps = true;
    });
    (sweeps ? time.sweepNs : time.dragNs) = host::monotonicNs() - last;
    return time;
}

}  // namespace lockstep
