// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lockstep {

/// Where a rank runs and what that machine has left.
struct RankHost {
    std::string name;
    std::int64_t freeBytes = 0;  // memory that may still be taken there, by all ranks together
};

/// Why ranks that take `bytesPerRank` each, and all but the first, the master, `bytesToDraw` more, do not fit their
/// hosts, for the host that lacks most; nothing when they do.
[[nodiscard]] std::optional<std::string> lackOfMemory(const std::vector<RankHost>& ranks, std::int64_t bytesPerRank,
                                                      std::int64_t bytesToDraw = 0);

}  // namespace lockstep
