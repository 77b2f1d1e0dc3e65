// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lockstep/session_message.hpp"

namespace master {

/// Adds a fault made on purpose to what the ranks are told. `text` is KIND:KEY=NUMBER,KEY=NUMBER,… as --inject takes
/// it (docs/operator.md), for a wall of so many render ranks. Throws files::InputError that says what can be written.
void inject(const std::string& text, int ranks, lockstep::SessionMessage& message);

}  // namespace master
