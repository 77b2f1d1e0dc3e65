// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "haptic_bridge/link/protocol.hpp"
#include "haptic_bridge/link/step_ring.hpp"

namespace haptic_bridge {

/// The master's permission for a server to number the steps: the first step, the steps before it, and the steps that
/// have come since. Used by one thread; can be copied.
class Grant {
public:
    Grant() = default;
    Grant(const StartMessage& start, StepRing recent)
        : start_(start), recent_(std::move(recent)), lastStep_(start.stepNumber) {}

    [[nodiscard]] const StartMessage& start() const { return start_; }
    [[nodiscard]] std::uint64_t lastStep() const { return lastStep_; }
    /// Returns whether the server may ask for sand. It may ask twice.
    [[nodiscard]] bool mayHandOver() const { return handOvers_ < 2; }
    /// Returns the CatchUps that bring the server's sand to the start. If the steps that it lacks are not known, or if
    /// the server asks again, returns none: awaitsState() is then true until stateGiven().
    [[nodiscard]] std::vector<CatchUp> catchUps(const NeedState& need);
    [[nodiscard]] bool awaitsState() const { return awaitsState_; }
    void stateGiven() { awaitsState_ = false; }
    /// Releases the steps for the server, because the server has begun.
    void begun() { recent_ = {}; }

    enum class Arrival { next, stale, foreign, afterGap, unasked };
    /// Classifies a step of the server by epoch, number and number of its edit. `unasked` is the next step with an edit
    /// that asked() does not know. If it is the next step, it counts as the last one from now on, and its edit as done.
    /// The step then gets the edit that was asked for, with its tuning or sand; what the server sent of these is
    /// dropped.
    [[nodiscard]] Arrival arrived(sand::Step& step);
    /// Notes that the server was asked for `edit`. One step may then hold its number. The server may also replace it by
    /// an edit that it is asked for later. Forgets the oldest of more than kMostAsked edits.
    void asked(const sand::Edit& edit);

    static constexpr std::size_t kMostAsked = 16;
    /// Limits the step number of `frame` to the steps of this grant. A frame that was drawn before the first step
    /// therefore reports no step of it.
    [[nodiscard]] Shown bounded(const Shown& frame) const;

private:
    StartMessage start_;
    StepRing recent_;
    std::deque<sand::Edit> asked_;  // edits that are in no step yet, oldest first
    int handOvers_ = 0;
    bool awaitsState_ = false;
    std::uint64_t lastStep_ = 0;
};

}  // namespace haptic_bridge
