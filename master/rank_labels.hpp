// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <vector>

#include "lockstep/cluster.hpp"
#include "master/failure_report.hpp"
#include "walls/wall.hpp"

namespace master {

/// Names of the ranks in messages, events and files, in order of rank, the master first.
struct RankLabels {
    std::vector<std::string> names;  // "rank 5 (tile r2c1) on node3"
    std::vector<std::string> hosts;  // hosts that the ranks run on
    std::vector<std::string> tiles;  // names of the tiles; empty for the master

    static RankLabels of(const lockstep::Cluster& cluster, const walls::Wall& wall) {
        RankLabels labels{{"the master"}, {cluster.hosts().front().name}, {""}};
        for (const walls::Tile& tile : wall.tiles) {
            const std::string& host = cluster.hosts()[static_cast<std::size_t>(tile.rank)].name;
            labels.names.push_back(fmt::format("rank {} (tile {}) on {}", tile.rank, tile.name, host));
            labels.hosts.push_back(host);
            labels.tiles.push_back(tile.name);
        }
        return labels;
    }

    /// Returns the report of a failure. `what` and `rank` are as in FailureReport; `line` is its message.
    [[nodiscard]] FailureReport failure(const std::string& what, int rank, const std::string& line) const {
        if (rank < 0) {
            return {what, rank, "", "", line};
        }
        const auto index = static_cast<std::size_t>(rank);
        return {what, rank, hosts[index], tiles[index], line};
    }
};

}  // namespace master
