// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace host {

/// Returns the memory that programs on this machine, or in this control group, may still take [byte].
[[nodiscard]] std::int64_t freeMemory();

/// Returns the memory that this process alone may still take [byte]: freeMemory(), or less under a limit of its own
/// (ulimit -v).
[[nodiscard]] std::int64_t freeMemoryOfProcess();

}  // namespace host
