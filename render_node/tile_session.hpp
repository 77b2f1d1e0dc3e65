// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lockstep/cluster.hpp"
#include "render_node/gl/gl_context.hpp"
#include "sand/grid/erosion.hpp"

namespace render_node {

/// Runs a render rank. Receives scene and wall from the master. Then, in each frame, applies the steps, draws, waits at
/// the barrier and swaps. Ends when the master stops the session.
///
/// @param sweeps  Options by which the rank's replica is swept.
/// @return Exit status. Collective with the master's Session.
[[nodiscard]] int showTile(const lockstep::Cluster& cluster, Backend backend,
                           const sand::grid::Erosion::Options& sweeps = {});

}  // namespace render_node
