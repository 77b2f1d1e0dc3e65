// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace host {

/// Returns the time of the host's monotonic clock [ns]. Every time stamp of the link comes from it.
[[nodiscard]] inline std::int64_t monotonicNs() {
    using namespace std::chrono;
    return duration_cast<nanoseconds>(steady_clock::now().time_since_epoch()).count();
}

}  // namespace host
