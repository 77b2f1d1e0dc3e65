// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/executor.hpp"
#include "lockstep/cluster.hpp"
#include "render_node/gl/gl_context.hpp"

namespace render_node {

/// Runs a render rank. Receives scene and wall from the master. Then, in each frame, applies the steps, draws, waits at
/// the barrier and swaps. Ends when the master stops the session.
///
/// @param executor  Shares out the work of the rank's replica; see sand::Replica.
/// @return Exit status. Collective with the master's Session.
[[nodiscard]] int showTile(const lockstep::Cluster& cluster, Backend backend, const base::Executor* executor = nullptr);

}  // namespace render_node
