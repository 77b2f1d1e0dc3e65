// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sand/history.hpp"
#include "sand/model/step.hpp"
#include "scene/model/material.hpp"

namespace master {

/// A step that the next frame shows, and what only the master knows about it. Each number is 0 if it is not known, as
/// in a replay.
struct ArrivedStep {
    sand::Step step;
    std::int64_t serverTimeNs = 0;  // when the server made it [ns, the server's clock]
    std::uint64_t serverHash = 0;   // state hash of the server's replica after the step
    std::int64_t receivedNs = 0;    // [ns, the master's clock]
    /// Up to when the step of a master has the movement of its hand [ns]; 0 if it has none, or if a server made it.
    std::int64_t handNs = 0;
    std::optional<std::uint64_t> client{};      // that waits for the answer to the step's edit
    std::optional<scene::Material> material{};  // of the session after the step's edit; nullopt if unchanged
    sand::History::Intent intent{};             // of the step's edit

    /// Returns up to when the step has the movement of the hand [ns, the clock of the epoch]; 0 if it has none.
    [[nodiscard]] std::int64_t readNs() const { return handNs != 0 ? handNs : serverTimeNs; }
};
using ArrivedSteps = std::vector<ArrivedStep>;

}  // namespace master
