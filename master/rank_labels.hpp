// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lockstep/cluster.hpp"
#include "master/failure_report.hpp"
#include "walls/wall.hpp"

namespace master {

/// How messages, events and files speak of each rank, by rank, the master first.
struct RankLabels {
    std::vector<std::string> names;  // "rank 5 (tile r2c1) on node3"
    std::vector<std::string> hosts;  // that it runs on
    std::vector<std::string> tiles;  // empty for the master

    static RankLabels of(const lockstep::Cluster& cluster, const walls::Wall& wall);

    /// Makes the report of a failure. `what` and `rank` are those of FailureReport; `line` is its message.
    [[nodiscard]] FailureReport failure(const std::string& what, int rank, const std::string& line) const;
};

}  // namespace master
