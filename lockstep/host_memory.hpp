// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/field_forms.hpp"
#include "lockstep/message_limits.hpp"

namespace lockstep {

/// Host of one rank, with its free memory.
struct RankHost {
    std::string name;
    std::int64_t freeBytes = 0;  // free memory for all ranks of this host together
    std::string machine{};       // as machineId() returns it
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("name", base::text(it.name, kMostText));
        visit("free_bytes", it.freeBytes);
        visit("machine", base::text(it.machine, kMostText));
    }
};

/// Returns the text of a message about the host that lacks most memory; nullopt if all ranks fit their hosts. A render
/// rank needs `bytesPerRank` + `bytesToDraw` [byte]. The master, which is the first of `ranks`, needs `bytesPerRank`.
[[nodiscard]] std::optional<std::string> lackOfMemory(const std::vector<RankHost>& ranks, std::int64_t bytesPerRank,
                                                      std::int64_t bytesToDraw = 0);

}  // namespace lockstep
