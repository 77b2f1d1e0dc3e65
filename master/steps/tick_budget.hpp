// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace master {

/// Limits the tick track that haptic servers may send, because every piece goes into the journal. A server that sends
/// more than its hand can make would fill the disk. Used by one thread; the caller passes the time.
class TickBudget {
public:
    // [byte] of one tick as haptic_bridge::encode() writes it: seven doubles, the flags, three varints of at most 10
    // bytes, and two coordinates of at most 4 bytes.
    static constexpr double kTick = 7 * 8 + 1 + 3 * 10 + 2 * 4;
    static constexpr double kPiece = 64;  // [byte], overhead of a piece in memory and in the journal
    // [byte/s] of a hand in real time. It makes 1000 ticks and at most 200 pieces a second. A sixth more allows for a
    // clock that runs fast.
    static constexpr double kPerSecond = (1000 * kTick + 200 * kPiece) * 7 / 6;
    // [byte] that may come at once. A recorder keeps less than 1 MiB while the wall stands still.
    static constexpr double kBurst = 20 * kPerSecond;

    /// `fastStepsPerSecond` is that of the scene under the fast pace, in which the hand's seconds are those of the
    /// steps. It is 0 in real time, in which steps give no budget.
    TickBudget(int fastStepsPerSecond, std::int64_t nowNs)
        : perStep_(fastStepsPerSecond > 0 ? kPerSecond / fastStepsPerSecond : 0), countedNs_(nowNs) {}

    /// Counts a step of the server.
    void step() { left_ = std::min(kBurst, left_ + perStep_); }
    /// Returns whether a piece of `bytes` bytes may be kept, and counts it if so.
    [[nodiscard]] bool take(std::size_t bytes, std::int64_t nowNs) {
        left_ = std::min(kBurst, left_ + static_cast<double>(nowNs - countedNs_) * 1e-9 * kPerSecond);
        countedNs_ = nowNs;
        const double cost = static_cast<double>(bytes) + kPiece;
        const bool fits = cost <= left_;
        left_ -= fits ? cost : 0;
        refused_ += fits ? 0 : 1;
        return fits;
    }
    /// Returns how many pieces were refused.
    [[nodiscard]] std::uint64_t refused() const { return refused_; }

private:
    double perStep_;  // [byte]
    double left_ = kBurst;
    std::int64_t countedNs_;
    std::uint64_t refused_ = 0;
};

}  // namespace master
