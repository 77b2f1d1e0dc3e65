// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "lockstep/cluster.hpp"

namespace lockstep {

/// Collective: how far this rank's clock is ahead of the master's [ns], 0 at the master.
///
/// Cristian's method: of 32 round trips per rank the shortest counts, and is taken to be the same both ways. Its error
/// is at most half of that round trip.
[[nodiscard]] std::int64_t clockAheadOfMaster(const Cluster& cluster);

}  // namespace lockstep
