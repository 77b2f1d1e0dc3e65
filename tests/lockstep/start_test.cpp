// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "tests/support/processes/run_ranks.hpp"

namespace {

/// Starts ranks with a limit of `seconds` for the start.
support::Ran startedWith(int seconds, int ranks, const char* what) {
    setenv("SANDWALL_START_TIMEOUT", std::to_string(seconds).c_str(), 1);
    support::Ran ran = support::runRanks(ranks, "start_ranks", what, "vader");
    unsetenv("SANDWALL_START_TIMEOUT");
    return ran;
}

TEST(Start, RanksTakeTheProgressOfTheMasterBeforeTheBroadcast) {
    for (const char* what : {"", "'goes back'", "refused"}) {
        const support::Ran ran = support::runRanks(3, "start_ranks", what, "vader");
        EXPECT_EQ(ran.status, 0) << ran.output;
        EXPECT_EQ(ran.output, "3 ranks, the last has 3 bytes; 1.00 made\n");
    }
}

// Without the progress, the ranks would wait for an hour.
TEST(Start, AMasterWhoseWorkGetsNoFurtherIsNamedAfterTheLimit) {
    const support::Ran ran = startedWith(3, 2, "hangs");
    EXPECT_EQ(ran.status, 1) << ran.output;
    EXPECT_NE(ran.output.find("the start waits for the made-up work for "), std::string::npos) << ran.output;
    EXPECT_NE(ran.output.find("the limit is 3 s, ending the job"), std::string::npos) << ran.output;
}

// The last rank takes 8 s. Without its progress the master would give up after 3 s, and the first rank after 6 s.
TEST(Start, NobodyGivesUpWhileARankGetsFurther) {
    const support::Ran ran = startedWith(3, 3, "'slow rank'");
    EXPECT_EQ(ran.status, 0) << ran.output;
    EXPECT_NE(ran.output.find("3 ranks, the last has 3 bytes; 1.00 made\n"), std::string::npos) << ran.output;
}

TEST(Start, ARankThatGetsNoFurtherIsNamedAfterTheLimit) {
    const support::Ran ran = startedWith(1, 3, "'hanging rank'");
    EXPECT_EQ(ran.status, 1) << ran.output;
    EXPECT_NE(ran.output.find("the start waits for rank 2 for "), std::string::npos) << ran.output;
}

}  // namespace
