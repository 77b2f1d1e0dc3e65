// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "haptic_bridge/hand/guard_counts.hpp"

namespace haptic_bridge {

/// Counts the ramps after faults. An arm that needs kRamps of them within kSeconds is not safe to push: it trips, until
/// reset().
///
/// Every fault that sends 0 counts, of the arm and of the loop. Faults in ticks without a gap count once, because one
/// ramp follows them. The ramp of a start, a pause and the shares of the force do not count. Used by one thread.
class Breaker {
public:
    static constexpr std::size_t kRamps = 3;
    static constexpr double kSeconds = 10;

    /// Takes a tick at `time` [s], which must never decrease. `acted` has the bits of its guards.
    void take(double time, std::uint32_t acted) {
        const bool fault = (acted & kFaults & ~bit(Guard::tripped)) != 0;
        if (fault && !fault_ && !tripped_) {
            double& oldest = faults_[next_];
            next_ = (next_ + 1) % kEarlier;
            tripped_ = time - oldest <= kSeconds;
            oldest = time;
        }
        fault_ = fault;
    }
    [[nodiscard]] bool tripped() const { return tripped_; }
    /// Forgets all faults.
    void reset() { *this = Breaker(); }
    /// Sets whether it has tripped. A replay calls this with what a recording says.
    void set(bool tripped) { tripped_ = tripped; }

private:
    static constexpr std::size_t kEarlier = kRamps - 1;
    static constexpr double kNever = -std::numeric_limits<double>::infinity();

    double faults_[kEarlier] = {kNever, kNever};  // [s], when the latest faults began
    std::size_t next_ = 0;                        // index of the oldest of them
    bool fault_ = false;                          // at the last tick
    bool tripped_ = false;
};

}  // namespace haptic_bridge
