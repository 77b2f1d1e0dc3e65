// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lockstep/cluster.hpp"
#include "master/measure/failure_report.hpp"
#include "walls/wall.hpp"

namespace master {

/// Names of the ranks in messages, events and files, in order of rank, the master first.
struct RankLabels {
    std::vector<std::string> names;  // "rank 5 (tile r2c1) on node3"
    std::vector<std::string> hosts;  // hosts that the ranks run on
    std::vector<std::string> tiles;  // names of the tiles; empty for the master

    static RankLabels of(const lockstep::Cluster& cluster, const walls::Wall& wall);

    /// Returns the report of a failure. `what` and `rank` are as in FailureReport; `line` is its message.
    [[nodiscard]] FailureReport failure(const std::string& what, int rank, const std::string& line) const;
};

}  // namespace master
