// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace bench {

/// Becomes scripts/latency.py, which starts whole sessions with the programs beside this one. Returns only by throwing:
/// base::InputError when there is no such script or Python.
[[noreturn]] void becomeLatency(const std::vector<std::string>& arguments);

}  // namespace bench
