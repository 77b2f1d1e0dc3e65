// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/processes/run_ranks.hpp"

namespace {

TEST(Start, RanksTakeTheProgressOfTheMasterBeforeTheBroadcast) {
    for (const char* what : {"", "'goes back'"}) {
        const support::Ran ran = support::runRanks(3, "start_ranks", what, "vader");
        EXPECT_EQ(ran.status, 0) << ran.output;
        EXPECT_EQ(ran.output, "3 ranks, the last has 3 bytes\n");
    }
}

// Without the progress, the ranks would wait for an hour.
TEST(Start, AMasterWhoseWorkGetsNoFurtherIsNamedAfterTheLimit) {
    setenv("SANDWALL_START_TIMEOUT", "3", 1);
    const support::Ran ran = support::runRanks(2, "start_ranks", "hangs", "vader");
    unsetenv("SANDWALL_START_TIMEOUT");
    EXPECT_EQ(ran.status, 1) << ran.output;
    EXPECT_NE(ran.output.find("the start waits for the made-up work for "), std::string::npos) << ran.output;
    EXPECT_NE(ran.output.find("the limit is 3 s, ending the job"), std::string::npos) << ran.output;
}

}  // namespace
