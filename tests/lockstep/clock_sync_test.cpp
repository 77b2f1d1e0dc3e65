// SPDX-License-Identifier: Apache-2.0
// The measurement of clocks between ranks that MPI has started.
#include <gtest/gtest.h>

#include "tests/support/processes/run_ranks.hpp"

namespace {

// The clocks are ahead by an hour, −5 s and 1 ns. Both ways of the shortest round trip take 20 ms, so that the
// measurement is exact.
TEST(ClockSync, MeasuresClocksThatDifferOverALinkOf20Milliseconds) {
    const support::Ran ran = support::runRanks(4, "clock_ranks", "");
    EXPECT_EQ(ran.status, 0) << ran.output;
    EXPECT_EQ(ran.output, "0 3600000000000 -5000000000 1\n");
}

}  // namespace
