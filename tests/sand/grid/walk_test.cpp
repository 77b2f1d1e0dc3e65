// SPDX-License-Identifier: Apache-2.0
// Compares the walk over the rows bit for bit with sweeps in two passes over all blocks.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "host/worker_pool.hpp"
#include "tests/sand/grid/random_worlds.hpp"
#include "tests/sand/grid/two_pass/solver.hpp"
#include "tests/support/seed.hpp"

namespace {

/// Executor that calls the tasks one after the other, and the last one first. It shows a strip that depends on another
/// strip, in every run.
const base::Executor kBackwards = [](int count, const std::function<void(int)>& task) {
    while (count > 0) {
        task(--count);
    }
};

/// Returns the number of sweeps to compare. scripts/walk.sh asks for more.
int wantedSweeps() {
    const char* const wanted = std::getenv("SANDWALL_SWEEPS");
    return wanted != nullptr ? std::stoi(wanted) : samples::kSlowBuild ? 500 : 10000;
}

/// Compares `sweeps` sweeps in random worlds of the given size.
void compare(int sweeps, int widest, int highest /* [cell] */, const base::Executor* executor) {
    unsigned seed = test::randomSeed();
    for (int done = 0; done < sweeps && !testing::Test::HasFatalFailure(); ++seed) {
        SCOPED_TRACE(test::again(seed));
        worlds::Pair<two_pass::Solver> pair(worlds::World(seed, widest, highest), executor);
        for (int part = 0; part < 6 && !testing::Test::HasFatalFailure(); ++part) {
            SCOPED_TRACE(fmt::format("{}, part {}", pair.text(), part));
            done += pair.sweep();
            pair.change();
        }
    }
}

TEST(Walk, EqualsTwoPassesInSmallWorlds) { compare(wantedSweeps(), 45, 45, nullptr); }

// Rows are swept in pieces of 256 cells.
TEST(Walk, EqualsTwoPassesInWideWorlds) { compare(wantedSweeps() / 10, 1000, 40, nullptr); }

TEST(Walk, EqualsTwoPassesWithStripsInAnyOrder) {
    compare(wantedSweeps() / 10, 200, 200, &kBackwards);
    compare(wantedSweeps() / 10, 500, 30, &kBackwards);
}

TEST(Walk, EqualsTwoPassesOnThreads) {
    host::WorkerPool team(3);
    compare(wantedSweeps() / 10, 200, 200, team.lend());
}

}  // namespace
