// SPDX-License-Identifier: Apache-2.0
#include "master/measure/rank_labels.hpp"

#include <fmt/format.h>

namespace master {

RankLabels RankLabels::of(const lockstep::Cluster& cluster, const walls::Wall& wall) {
    RankLabels labels{{"the master"}, {cluster.hosts().front().name}, {""}};
    for (const walls::Tile& tile : wall.tiles) {
        const std::string& host = cluster.hosts()[static_cast<std::size_t>(tile.rank)].name;
        labels.names.push_back(fmt::format("rank {} (tile {}) on {}", tile.rank, tile.name, host));
        labels.hosts.push_back(host);
        labels.tiles.push_back(tile.name);
    }
    return labels;
}

FailureReport RankLabels::failure(const std::string& what, int rank, const std::string& line) const {
    if (rank < 0) {
        return {what, rank, "", "", line};
    }
    const auto index = static_cast<std::size_t>(rank);
    return {what, rank, hosts[index], tiles[index], line};
}

}  // namespace master
