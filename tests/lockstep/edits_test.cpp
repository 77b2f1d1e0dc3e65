// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "tests/support/run_program.hpp"

namespace {

/// One rank for each number from `first` to `last`, so that a slow machine sees a test end now and then.
void expectOneHash(int first, int last) {
    for (int ranks = first; ranks <= last; ++ranks) {
        const support::Ran ran = support::runCommand(
            "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1 timeout 600 "
            "mpirun -q --oversubscribe --bind-to none --mca btl self,vader --mca oob_tcp_if_include lo -n " +
            std::to_string(ranks) + " " SANDWALL_BIN_DIR "/edits_ranks");
        EXPECT_EQ(ran.status, 0) << ran.output;
        // That of one rank, which has nobody to differ from. Whoever changes the algorithm replaces it, as the golden
        // hashes.
        EXPECT_EQ(ran.output, "104713705b65770e\n") << ranks << " ranks";
    }
}

TEST(Edits, TenThousandHashAlikeOnOneToFourRanks) { expectOneHash(1, 4); }
TEST(Edits, TenThousandHashAlikeOnFiveToEightRanks) { expectOneHash(5, 8); }
TEST(Edits, TenThousandHashAlikeOnNineToTwelveRanks) { expectOneHash(9, 12); }

}  // namespace
