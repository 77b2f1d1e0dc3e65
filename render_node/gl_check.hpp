// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace render_node {

/// `sandwall-render-node --probe RANK`: makes what that rank of the wall on standard input would draw with, windows and
/// all, prints its renderer and then each shortcoming in a line of its own, and ends: is this host fit for its tiles?
/// With `--json` it prints one object instead, with `backend`, `renderer` and the list `shortcomings`. Rank 0 needs no
/// wall and has no windows. No MPI. Returns the exit status; complaints go to stderr, one line.
int probeMain(int argc, char** argv);

}  // namespace render_node
