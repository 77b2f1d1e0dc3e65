// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "haptic_bridge/hand/frame_cost.hpp"
#include "haptic_bridge/hand/pace.hpp"
#include "haptic_bridge/hand/path_builder.hpp"
#include "sand/replica.hpp"

namespace haptic_bridge {

/// Returns whether the next step of `replica` leaves the hand where it is, because sweeps are owed. In real time a hand
/// that hovers does not wait, because it moves no sand.
[[nodiscard]] bool holdsHand(const sand::Replica& replica, Pace pace);

/// Decides how much work of the sand fits into a frame: how many sweeps a step runs, how far it moves the tool, and how
/// many of the steps that are due a frame takes, at least one. docs/how_it_works.md#a-step has the rules.
///
/// The sand after all sweeps of a step does not depend on these numbers. In real time the path of the hand does.
/// Reads no clock. Used by one thread.
class SweepBudget {
public:
    static constexpr std::int32_t kFastPart = 64;          // [sweep], in every step under the fast pace
    static constexpr std::int64_t kMostNs = 80'000'000;    // [ns], of sand in a frame
    static constexpr std::int64_t kFrameNs = 200'000'000;  // [ns], of sand and drawing, if the sand has kLeastNs
    static constexpr std::int64_t kLeastNs = 20'000'000;   // [ns], of sand in a frame whose drawing is long
    static constexpr std::int64_t kCellNs = 2;             // [ns], of a cell that moves, in a sweep of a large field

    /// `periodNs` is that of the steps [ns].
    SweepBudget(Pace pace, std::int64_t periodNs) : pace_(pace), periodNs_(periodNs) {}

    /// Takes the cost of a frame. `step` is the number of its last step.
    void shown(const FrameCost& cost, std::uint64_t step);

    /// Returns the sweeps of `step`, which is the next of `replica` and has everything except its sweeps; 0 for a TIN.
    [[nodiscard]] std::int32_t sweepsOf(const sand::Step& step, const sand::Replica& replica);
    [[nodiscard]] bool holdsHand(const sand::Replica& replica) const {
        return haptic_bridge::holdsHand(replica, pace_);
    }
    /// Returns how many sub-steps of the tool the next step of `replica` may have, at least 1. Under the fast pace only
    /// the rules limit them. While sweeps are owed, the step takes only samples that hover.
    [[nodiscard]] SubstepLimit substeps(const sand::Replica& replica) const;
    /// Returns whether a frame whose steps ask for `taken` may take a further step of `tool` that asks for `further`.
    [[nodiscard]] bool fits(const sand::StepWork& taken, const sand::StepWork& further, const sand::Tool& tool) const;

    [[nodiscard]] std::int64_t budgetNs() const;  // [ns], for sand in a frame

private:
    void begin(std::int64_t part, std::uint64_t step);
    /// Returns the sweeps that fit if all sand moves.
    [[nodiscard]] std::int64_t whenAllMoves(const sand::Replica& replica) const;
    /// Returns how many times as long a sweep is after a drag of `substeps` as sweepNs_.
    [[nodiscard]] double widened(std::int64_t substeps, const sand::Tool& tool) const;
    /// Returns the sweeps that take `ns` after a drag of `substeps`.
    [[nodiscard]] double sweepsIn(double ns, std::int64_t substeps, const sand::Tool& tool) const;

    Pace pace_;
    std::int64_t periodNs_;
    std::int64_t drawNs_ = 0, hashNs_ = 0;  // of the last frame
    double sweepNs_ = 0, substepNs_ = 0;    // [ns], of one of them; 0: not known
    double phaseNs_ = 0;                    // [ns], of a coarse phase; 0: not known
    std::int64_t substeps_ = 0;             // of the drag after which sweepNs_ was measured
    double growth_ = 1;                     // of sweepNs_ since the frame before, from 1 to kMostGrowth
    std::int64_t part_ = 0;                 // [sweep], at most in a step; 0 before the first step
    std::uint64_t since_ = 0;               // frames before this step do not let parts grow
};

}  // namespace haptic_bridge
