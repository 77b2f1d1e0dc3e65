// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "haptic_bridge/link/protocol.hpp"

namespace haptic_bridge {

/// The last steps of the sand, for a server that comes back and lacks only those. Bounded; a value.
class StepRing {
public:
    static constexpr std::size_t kSteps = 240;  // four seconds: applied more quickly than a large sand is sent

    /// The sand has this hash after this step; steps before it may or may not have been told.
    void reached(std::uint64_t stepNumber, std::uint64_t stateHash);
    /// The next step; one that does not follow the last begins anew, and so does one with sand that is loaded.
    void add(const sand::Step& step);
    /// The steps from there to `stepNumber`, if that hash was reached there and all are known.
    [[nodiscard]] std::optional<std::vector<sand::Step>> since(const NeedState& there, std::uint64_t stepNumber) const;

private:
    struct Entry {
        sand::Step step;
        std::optional<std::uint64_t> hash;  // after it
    };
    std::uint64_t begin_ = 0;  // number of the step before the first
    std::optional<std::uint64_t> beginHash_;
    std::deque<Entry> entries_;
};

}  // namespace haptic_bridge
