// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/fuzz/structure/sessions.hpp"

namespace structure {

/// Returns the state of a replica of `session` with some changed numbers, in an encoding that is right.
[[nodiscard]] base::Bytes changedState(const Session& session, Chance& chance);
/// Returns its sand, or that of another session, with some changed numbers, in an encoding that is right.
[[nodiscard]] base::Bytes changedSand(const sand::Replica& sand, Chance& chance);
/// Changes one number of a material and a tool.
void change(sand::Tuning& tuning, Chance& chance);

}  // namespace structure
