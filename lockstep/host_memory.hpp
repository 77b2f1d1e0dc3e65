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

/// Memory that a rank needs.
struct RankNeed {
    std::int64_t bytes = 0;   // [byte]
    std::int64_t shared = 0;  // part of it that the other ranks of its host share, because it is code [byte]
};

/// Returns the text of a message about the host that lacks most memory; nullopt if all ranks fit their hosts. `needs`
/// has the need of each rank.
[[nodiscard]] std::optional<std::string> lackOfMemory(const std::vector<RankHost>& ranks,
                                                      const std::vector<RankNeed>& needs);

}  // namespace lockstep
