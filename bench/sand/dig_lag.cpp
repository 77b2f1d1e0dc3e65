// SPDX-License-Identifier: Apache-2.0
#include "bench/sand/dig_lag.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "bench/sand/piles.hpp"
#include "bench/sand/relaxations.hpp"
#include "sand/grid/displacement.hpp"
#include "sand/grid/erosion.hpp"

namespace bench {
namespace {

constexpr int kMostAfter = 2000;  // largest number of steps after lifting
constexpr int kMostHeld = 20000;  // largest number of steps until sand rests on a held tool
constexpr double kHigher = 0.5;   // [cell], from which sand above its settled height counts as a bank

/// Heights over the level, row by row [cell].
using Heights = std::vector<double>;

Heights heightsOf(const sand::HeightField& field) {
    Heights heights;
    for (int y = 0; y < field.rows(); ++y) {
        for (int x = 0; x < field.columns(); ++x) {
            heights.push_back(static_cast<double>(field.height(x, y)) / sand::kUnitsPerCell);
        }
    }
    return heights;
}

Heights heightsOf(const sand::Surface& tin, int side) {
    Heights heights;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            heights.push_back(tin.height((x + 0.5) * sand::kProbePerCell, (y + 0.5) * sand::kProbePerCell) /
                              sand::kUnitsPerCell);
        }
    }
    return heights;
}

/// Sets all of a lag but stepsAfter. `held` and `lifted` are the settled heights with the tool and without it.
Lag compared(const Heights& end, const Heights& held, const Heights& lifted, int side) {
    Lag lag{.held = misplaced(end, held), .lifted = misplaced(end, lifted)};
    lag.bank = std::max(0.0, *std::ranges::max_element(end));
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const auto cell = static_cast<std::size_t>(y * side + x);
            if (end[cell] - lifted[cell] > kHigher) {
                lag.bankReach = std::max(lag.bankReach, std::abs(x - y) / std::numbers::sqrt2);
            }
        }
    }
    return lag;
}

/// Applies steps with the tool lifted until 1 % of the sand has yet to move. Returns their number.
int stepsAfter(sand::Replica& replica, const Heights& lifted, const std::function<Heights()>& heights) {
    int steps = 0;
    for (; steps < kMostAfter && misplaced(heights(), lifted) > 0.01; ++steps) {
        replica.apply({1, replica.stepNumber() + 1, false, {}});
    }
    return steps;
}

/// Applies steps to a copy of `replica` until its sand rests. Returns the copy.
sand::Replica atRest(const sand::Replica& replica, bool engaged) {
    sand::Replica copy(replica);
    for (int i = 0; i < kMostHeld; ++i) {
        copy.apply({1, copy.stepNumber() + 1, engaged, {}});
        if (copy.settled()) {
            break;
        }
    }
    return copy;
}

}  // namespace

Lag lagOfGrid(sand::Replica& replica) {
    const sand::HeightField& field = std::get<sand::GridData>(replica.surface().data()).field;
    const sand::HeightField end = field;
    const sand::grid::Obstacle tool = sand::grid::Displacement(replica.tool()).obstacle(end, replica.probe());
    sand::HeightField held = end;
    sand::grid::Erosion(held, replica.rules()).sweep(held, kMostSweeps, &tool);
    sand::HeightField lifted = end;
    sweepToRest(lifted, replica.rules());
    const Heights rest = heightsOf(lifted);
    Lag lag = compared(heightsOf(end), heightsOf(held), rest, end.columns());
    lag.stepsAfter = stepsAfter(replica, rest, [&] { return heightsOf(field); });
    return lag;
}

Lag lagOfTin(sand::Replica& replica, int side) {
    const Heights end = heightsOf(replica.surface(), side);
    const Heights held = heightsOf(atRest(replica, true).surface(), side);
    const Heights rest = heightsOf(atRest(replica, false).surface(), side);
    Lag lag = compared(end, held, rest, side);
    lag.stepsAfter = stepsAfter(replica, rest, [&] { return heightsOf(replica.surface(), side); });
    return lag;
}

}  // namespace bench
