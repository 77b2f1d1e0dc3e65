// SPDX-License-Identifier: Apache-2.0
#include "lockstep/host_memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

namespace lockstep {
namespace {

constexpr std::int64_t kUnlimited = std::numeric_limits<std::int64_t>::max();

double gibibytes(std::int64_t bytes) { return static_cast<double>(bytes) / (1 << 30); }

}  // namespace

std::optional<std::string> lackOfMemory(const std::vector<RankHost>& ranks, const std::vector<RankNeed>& needs) {
    struct Host {
        std::int64_t ranks = 0, bytes = 0, shared = 0;
        std::int64_t freeBytes = kUnlimited;
    };
    std::map<std::string, Host> hosts;
    for (std::size_t rank = 0; rank < ranks.size(); ++rank) {
        Host& host = hosts[ranks[rank].name];
        ++host.ranks;
        host.bytes += needs.at(rank).bytes - needs[rank].shared;
        host.shared = std::max(host.shared, needs[rank].shared);
        host.freeBytes = std::min(host.freeBytes, ranks[rank].freeBytes);
    }
    const auto lack = [&](const Host& host) { return host.bytes + host.shared - host.freeBytes; };
    const auto worst = std::max_element(hosts.begin(), hosts.end(),
                                        [&](const auto& a, const auto& b) { return lack(a.second) < lack(b.second); });
    if (worst == hosts.end() || lack(worst->second) <= 0) {
        return std::nullopt;
    }
    const auto& [name, host] = *worst;
    return fmt::format("{:.1f} GiB for the {} on {}, where {:.1f} GiB are free", gibibytes(host.bytes + host.shared),
                       host.ranks == 1 ? "one rank" : fmt::format("{} ranks", host.ranks), name,
                       gibibytes(host.freeBytes));
}

}  // namespace lockstep
