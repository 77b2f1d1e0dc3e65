// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lockstep {

/// How one wait for a message is spent: MPI can only be asked whether it is there, and asking without rest would burn
/// the core of whoever draws, or of a wall that stands still.
///
/// At first it yields, so that a short wait ends as soon as it can; then it sleeps, always the same share of what the
/// wait has taken so far, so that no wait is made longer by more than that share, nor by more than an eighth of a
/// millisecond: swaps lie no further apart for it. One wait per object; any thread.
class Patience {
public:
    /// Between two looks.
    void rest();

    /// How long to sleep after having waited so long; 0: only yield. [ns]
    [[nodiscard]] static std::int64_t sleepAfter(std::int64_t waited);

private:
    std::int64_t since_ = 0;  // [ns], of the first rest
};

/// Has this thread wake when its sleep ends: Linux adds 50 µs to each sleep otherwise, and newer ones let whoever
/// computes on the core finish some milliseconds before.
void wakePunctually();

}  // namespace lockstep
