// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

#include "tests/support/processes/run_ranks.hpp"

namespace {

const std::string kOfSpheres = "bea62df5b671b328", kOfEveryTool = "b059635b20e432d6", kOfTin = "48965106575b47c3";

/// `hash` is the hash of one rank, which cannot differ from another. A change of the algorithm replaces it, together
/// with the golden hashes.
void expectHash(std::initializer_list<int> numbersOfRanks, const std::string& arguments, const std::string& hash) {
    for (const int ranks : numbersOfRanks) {
        const support::Ran ran = support::runRanks(ranks, "edits_ranks", arguments);
        EXPECT_EQ(ran.status, 0) << ran.output;
        EXPECT_EQ(ran.output, hash + "\n") << ranks << " ranks";
    }
}

// Rank r sweeps with 1, 2, 3 or 7 threads, in blocks of 16, 32 or 64 cells, on one of up to three code paths.
// Twelve ranks have each number of threads with each size of block and with each path. One, two and four ranks show
// that the sand does not depend on the number of ranks.
TEST(Edits, TenThousandHashAlikeOnOneTwoFourAndTwelveRanks) { expectHash({1, 2, 4, 12}, "", kOfSpheres); }
TEST(Edits, WithEveryToolHashAlikeOnFourRanks) { expectHash({4}, "tools", kOfEveryTool); }
TEST(Edits, OfATinHashAlikeOnTwelveRanks) { expectHash({12}, "tin", kOfTin); }

}  // namespace
