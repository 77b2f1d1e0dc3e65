// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "haptic_bridge/link/protocol.hpp"

namespace haptic_bridge {

/// The latest steps of the sand. A server that reconnects and lacks only these gets them instead of the whole sand.
/// Holds at most kSteps steps; can be copied.
class StepRing {
public:
    // Four seconds at 60 steps per second. Applying them is faster than sending a large sand.
    static constexpr std::size_t kSteps = 240;

    /// Records that the sand has `stateHash` after step `stepNumber`. Earlier steps need not be known.
    void reached(std::uint64_t stepNumber, std::uint64_t stateHash);
    /// Adds the next step. If it does not follow the last one, or if it loads sand, the ring begins again after it.
    void add(const sand::Step& step);
    /// Returns the steps after `there` up to `stepNumber`. Returns nullopt if the sand of `there` is unknown or
    /// differs, or if a step is missing.
    [[nodiscard]] std::optional<std::vector<sand::Step>> since(const NeedState& there, std::uint64_t stepNumber) const;

private:
    struct Entry {
        sand::Step step;
        std::optional<std::uint64_t> hash;  // of the sand after the step
    };
    std::uint64_t begin_ = 0;  // number of the step before the first entry
    std::optional<std::uint64_t> beginHash_;
    std::deque<Entry> entries_;
};

}  // namespace haptic_bridge
