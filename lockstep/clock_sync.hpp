// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "lockstep/cluster.hpp"

namespace lockstep {

/// Returns how far this rank's clock is ahead of the master's [ns]; 0 at the master. Collective.
///
/// Uses Cristian's method: takes the shortest of 32 round trips per rank and assumes that both ways took equally long.
/// The error is at most half of that round trip.
[[nodiscard]] std::int64_t clockAheadOfMaster(const Cluster& cluster);

}  // namespace lockstep
