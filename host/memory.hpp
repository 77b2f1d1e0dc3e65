// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace host {

/// Returns the memory that is still free on this machine, or in this control group [byte].
[[nodiscard]] std::int64_t freeMemory();

/// Returns the memory that this process may still allocate [byte]. It is freeMemory(), or less if the process has a
/// limit (ulimit -v).
[[nodiscard]] std::int64_t freeMemoryOfProcess();

}  // namespace host
