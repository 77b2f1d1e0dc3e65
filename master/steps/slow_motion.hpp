// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "master/steps/arrived_step.hpp"

namespace master {

/// Measures by how much the tool is slower in the sand than the hand: the time that has passed, divided by the time of
/// the hand whose movement is in steps. Both count from the step that engages the tool to the step that lifts it.
///
/// The tool is slower while it waits for sweeps that are owed, and if the wall cannot keep up. Movement that is dropped
/// is in no step. Used by one thread.
class SlowMotion {
public:
    static constexpr std::int64_t kLeastNs = 500'000'000;  // [ns], in the sand, before there is a factor

    explicit SlowMotion(int stepsPerSecond);

    /// Adds the steps of a frame. `passedNs` is the time since the frame before [ns]; 0 if the session was paused.
    void add(std::int64_t passedNs, const ArrivedSteps& steps);
    /// Adds a frame without steps in which sand and hand were at rest. `passedNs` is the time since the frame before
    /// [ns]. The hand takes as long, as in steps without a path.
    void addRest(std::int64_t passedNs);

    /// Returns the factor; nullopt if the tool of a hand was in the sand for less than kLeastNs.
    [[nodiscard]] std::optional<double> factor() const;

private:
    std::int64_t periodNs_;  // [ns], of a step
    std::int64_t passedNs_ = 0, takenNs_ = 0;
    bool engaged_ = false;     // after the last step of a hand
    std::int64_t readNs_ = 0;  // of the last step of a hand, see ArrivedStep::readNs()
    std::uint32_t epoch_ = 0;  // each epoch may have another clock
};

}  // namespace master
