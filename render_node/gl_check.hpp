// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace render_node {

/// Runs `sandwall-render-node --probe RANK`, which checks whether a host is fit for its tiles.
///
/// Makes the context and the windows that rank RANK of the wall on standard input would use. Prints the renderer, and
/// then one line for each shortcoming. With `--json` it prints one object with `backend`, `renderer` and the list
/// `shortcomings` instead. With `--gl glfw` it has the `work_area` of the first monitor, too, also for rank 0. Rank 0
/// needs no wall and has no windows. Does not use MPI. Returns the exit status. Prints errors on standard error, one
/// line each.
int probeMain(int argc, char** argv);

}  // namespace render_node
