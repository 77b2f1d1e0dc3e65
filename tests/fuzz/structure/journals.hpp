// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tests/fuzz/structure/sessions.hpp"

namespace structure {

/// Returns the parts of a journal of `session` with some changed records, steps or numbers. All checksums are right.
[[nodiscard]] std::vector<base::Bytes> changedJournal(const Session& session, Chance& chance);

}  // namespace structure
