// SPDX-License-Identifier: Apache-2.0
// Compares the walk over the rows bit for bit with sweeps in two passes over all blocks. scripts/checks/walk.sh
// compares more sweeps.
#include <gtest/gtest.h>

#include "host/worker_pool.hpp"
#include "tests/sand/grid/random_worlds.hpp"
#include "tests/sand/grid/two_pass/solver.hpp"
#include "tests/support/seed.hpp"

namespace {

constexpr int kSweeps = samples::kSlowBuild ? 500 : 4000;
constexpr int kFew = kSweeps / 10;  // in large worlds

/// Executor that calls the tasks one after the other, and the last one first. It shows a strip that depends on another
/// strip, in every run.
const base::Executor kBackwards = [](int count, const std::function<void(int)>& task) {
    while (count > 0) {
        task(--count);
    }
};

void compare(int sweeps, int widest, int highest /* [cell] */, const worlds::Way& way) {
    EXPECT_EQ(worlds::firstDifference<two_pass::Solver>(test::randomSeed(), sweeps, widest, highest, way), "")
        << "run again with this seed in SANDWALL_SEED";
}

TEST(Walk, EqualsTwoPassesInSmallWorldsOnEveryPath) {
    for (const base::CodePath path : base::codePathsHere()) {
        compare(kSweeps, 45, 45, {.path = path});
    }
}

// Rows are swept in pieces of 256 cells.
TEST(Walk, EqualsTwoPassesInWideWorlds) {
    for (const base::CodePath path : base::codePathsHere()) {
        compare(kFew, 1000, 40, {.path = path});
    }
}

// Short runs of blocks are swept in another way than long ones.
TEST(Walk, EqualsTwoPassesInWorldsOfLumps) {
    for (const base::CodePath path : base::codePathsHere()) {
        compare(kSweeps, 100, 100, {.path = path, .lumpy = true});
    }
    compare(kSweeps, 200, 200, {.executor = &kBackwards, .lumpy = true});
}

TEST(Walk, EqualsTwoPassesWithStripsInAnyOrder) {
    compare(kFew, 200, 200, {.executor = &kBackwards});
    compare(kFew, 500, 30, {.executor = &kBackwards});
}

TEST(Walk, EqualsTwoPassesOnThreads) {
    for (const int threads : {2, 3, 7}) {
        host::WorkerPool team(threads);
        for (const base::CodePath path : base::codePathsHere()) {
            compare(kFew, 200, 200, {.executor = team.lend(), .path = path});
        }
    }
}

}  // namespace
