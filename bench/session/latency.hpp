// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace bench {

/// Replaces this process by scripts/figures/sessions/latency.py, which starts whole sessions with the
/// programs beside this one.
/// Throws base::InputError if the script or Python cannot be found. Does not return.
[[noreturn]] void becomeLatency(const std::vector<std::string>& arguments);

}  // namespace bench
