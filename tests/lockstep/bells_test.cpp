// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "tests/support/processes/run_ranks.hpp"

namespace {

std::string bellsOf(int ranks, const std::string& transport) {
    const support::Ran ran = support::runRanks(ranks, "bells_ranks", "", transport);
    EXPECT_EQ(ran.status, 0) << ran.output;
    return ran.output;
}

TEST(HostBells, AreThereForEveryRankOfTheHost) { EXPECT_EQ(bellsOf(5, "vader"), "5 ranks, 5 bells, 5 woken\n"); }

// Open MPI's own shared windows crash with a segmentation fault here.
TEST(HostBells, AreThereWhereRanksTalkOverTcp) { EXPECT_EQ(bellsOf(3, "tcp"), "3 ranks, 3 bells, 3 woken\n"); }

TEST(HostBells, AreNotThereForWhoIsAlone) { EXPECT_EQ(bellsOf(1, "vader"), "1 ranks, 0 bells, 0 woken\n"); }

}  // namespace
