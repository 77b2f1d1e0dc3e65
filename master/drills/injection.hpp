// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lockstep/fault.hpp"

namespace master {

/// Ranks, cells and link that a fault can strike.
struct FaultTargets {
    int ranks = 0;              // render ranks
    int columns = 0, rows = 0;  // size of the sand [cell]
    bool link = false;          // whether the session has a haptic server
    bool movement = true;       // whether the sand records movement, as that of a height field does
};

/// Parses a fault as the option --inject takes it: KIND:KEY=NUMBER,KEY=NUMBER,… (docs/operator.md). Throws
/// base::InputError, which describes the valid forms.
[[nodiscard]] lockstep::Fault parseFault(const std::string& text, const FaultTargets& targets);

}  // namespace master
