// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/replica.hpp"

namespace bench {

/// The sand at the end of a stroke, compared with settled sand.
struct Lag {
    double held = 0, lifted = 0;  // share of the displaced sand that still has to move
    double bank = 0;              // [cell]
    double bankReach = 0;         // [cell], from the diagonal of the field
    int stepsAfter = 0;
};

/// Compares the sand of `replica`, which digs along the diagonal of a grid, with the same sand settled. Then lifts the
/// tool, and applies steps until 1 % of the sand has yet to move.
Lag lagOfGrid(sand::Replica& replica);

/// Does the same for a TIN on `side` x `side` cells. Samples its heights at the middles of cells.
Lag lagOfTin(sand::Replica& replica, int side /* [cell] */);

}  // namespace bench
