// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lockstep/fault.hpp"

namespace master {

/// What a fault can strike.
struct FaultTargets {
    int ranks = 0;              // that draw
    int columns = 0, rows = 0;  // [cell], of the sand
    bool link = false;          // whether there is a haptic server to be linked to
};

/// Reads a fault made on purpose: KIND:KEY=NUMBER,KEY=NUMBER,… as --inject takes it (docs/operator.md). Throws
/// base::InputError that says what can be written.
[[nodiscard]] lockstep::Fault parseFault(const std::string& text, const FaultTargets& targets);

}  // namespace master
