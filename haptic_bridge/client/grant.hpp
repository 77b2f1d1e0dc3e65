// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <vector>

#include "haptic_bridge/link/protocol.hpp"
#include "haptic_bridge/link/step_ring.hpp"

namespace haptic_bridge {

/// The numbering as a master has handed it over: from where on, with what sand, and which steps have come since. A
/// value; used by one thread.
class Grant {
public:
    Grant() = default;
    Grant(const Start& start, base::Bytes state, StepRing recent)
        : start_(start), state_(std::move(state)), recent_(std::move(recent)), lastStep_(start.stepNumber) {}

    [[nodiscard]] const Start& start() const { return start_; }
    [[nodiscard]] std::uint64_t lastStep() const { return lastStep_; }
    /// The server asks for sand, at most twice.
    [[nodiscard]] bool mayHandOver() const { return handOvers_ < 2; }
    /// Returns the messages that bring the server's sand to the start: CatchUps with the steps that it lacks. Returns
    /// the State if these steps are not known, or if the server asks again.
    [[nodiscard]] std::vector<Message> handOver(const NeedState& need);
    /// The server has begun: the sand for it is released.
    void begun() {
        state_ = {};
        recent_ = {};
    }

    enum class Arrival { next, stale, foreign, afterGap };
    /// Judges a step of the server by epoch and number. The next one counts as the last from now on.
    [[nodiscard]] Arrival arrived(const sand::Step& step);
    /// Limits `frame` to what the server may be told: a frame that was drawn before the first step says nothing about
    /// the steps.
    [[nodiscard]] Shown bounded(const Shown& frame) const;

private:
    Start start_;
    base::Bytes state_;
    StepRing recent_;
    int handOvers_ = 0;
    std::uint64_t lastStep_ = 0;
};

}  // namespace haptic_bridge
