// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "haptic_bridge/hand/path_builder.hpp"
#include "sand/replica.hpp"

namespace haptic_bridge {

/// Hand whose movement becomes the paths of steps: of a device, of a server without sand, or of a pointer.
///
/// It takes over a tool from another hand, gathers samples, and fills steps with them. A derived class only adds
/// samples, in the order of time. Used by one thread.
class Hand {
public:
    explicit Hand(int stepsPerSecond) : path_(stepsPerSecond) {}
    virtual ~Hand() = default;
    Hand(const Hand&) = delete;
    Hand& operator=(const Hand&) = delete;

    /// Takes over the tool where `sand` has it. If it is in the sand, the first step lifts it, because it would
    /// otherwise draw a furrow from there to the hand.
    virtual void begin(const sand::Replica& sand);
    /// Drops the samples that wait. Steps hover until the next begin().
    virtual void end();
    /// Returns whether the hand has begun and has not ended.
    [[nodiscard]] bool present() const { return present_; }

    /// Fills `step.engaged`, `step.path` and `step.heading` with the movement since the step before. Returns when the
    /// last of its samples was read [ns, the samples' clock]. Returns 0 if the step has no sample that was read.
    /// The path keeps within `limit`.
    ///
    /// Do not call it while holdsHand() (sweep_budget.hpp): the movement waits.
    std::int64_t fill(sand::Step& step, const SubstepLimit& limit = {});
    /// Returns when the oldest engaged sample that waits and moves the tool was read [ns]. Returns nullopt if no such
    /// sample waits.
    [[nodiscard]] std::optional<std::int64_t> engagedSinceNs() const { return path_.engagedSinceNs(); }

    /// Returns whether samples wait for the next step.
    [[nodiscard]] bool waits() const { return path_.waits(); }
    /// Returns whether the next step would move the tool.
    [[nodiscard]] bool moves() const { return present_ && (liftFirst_ || path_.moves()); }
    /// Forgets the samples that wait, because the sand rests and no step takes them. Only while moves() is false.
    void forgetRest() { path_.forgetRest(); }

    /// Returns the number of samples that were dropped while the hand was present (PathBuilder::dropped()).
    [[nodiscard]] virtual std::uint64_t dropped() const { return path_.dropped(); }

protected:
    /// Adds a sample. Ignores it while the hand is not present.
    void add(const HandSample& sample);
    /// Returns the last sample that was added. Before the first one, it hovers where begin() found the tool.
    [[nodiscard]] const HandSample& last() const { return last_; }
    /// Adds the samples of the next step, if the hand is read once for each step. fill() calls it.
    virtual void collect() {}

private:
    PathBuilder path_;
    HandSample last_;
    bool present_ = false;
    bool liftFirst_ = false;  // the next step only lifts the tool
};

}  // namespace haptic_bridge
