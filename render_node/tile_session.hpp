// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lockstep/cluster.hpp"
#include "render_node/gl/gl_context.hpp"
#include "sand/grid/erosion.hpp"

namespace render_node {

/// The life of a render rank: takes scene and wall from the master, then replica, drawing, barrier, swap per frame,
/// until the master says stop. `sweeps` says how its replica is swept. Returns the exit status. Collective with the
/// master's Session.
[[nodiscard]] int showTile(const lockstep::Cluster& cluster, Backend backend,
                           const sand::grid::Erosion::Options& sweeps = {});

}  // namespace render_node
