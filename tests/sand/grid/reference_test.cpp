// SPDX-License-Identifier: Apache-2.0
// Compares the solver bit for bit with direct sweeps of the law (tests/support/sand/reference_sand.hpp).
#include <gtest/gtest.h>

#include "tests/sand/grid/random_worlds.hpp"
#include "tests/support/sand/reference_sand.hpp"
#include "tests/support/seed.hpp"

namespace {

TEST(Reference, EqualsTheSolverInRandomWorlds) {
    constexpr int kSweeps = samples::kSlowBuild ? 1500 : 30000;
    EXPECT_EQ(worlds::firstDifference<reference::Sand>(test::randomSeed(), kSweeps, 45, 45), "")
        << "run again with this seed in SANDWALL_SEED";
}

}  // namespace
