// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

#include "tests/support/run_ranks.hpp"

namespace {

const std::string kOfSpheres = "104713705b65770e", kOfEveryTool = "07877fabb68c6f49", kOfTin = "7fe497fd9b34532d";

/// The hash is that of one rank, which has nobody to differ from. Whoever changes the algorithm replaces it, as the
/// golden hashes.
void expectHash(std::initializer_list<int> numbersOfRanks, const std::string& arguments, const std::string& hash) {
    for (const int ranks : numbersOfRanks) {
        const support::Ran ran = support::runRanks(ranks, "edits_ranks", arguments);
        EXPECT_EQ(ran.status, 0) << ran.output;
        EXPECT_EQ(ran.output, hash + "\n") << ranks << " ranks";
    }
}

TEST(Edits, TenThousandHashAlikeOnOneToFourRanks) { expectHash({1, 2, 3, 4}, "", kOfSpheres); }
TEST(Edits, WithEveryToolHashAlikeOnOneAndFourRanks) { expectHash({1, 4}, "tools", kOfEveryTool); }
TEST(Edits, OfATinHashAlikeOnOneFourAndTwelveRanks) { expectHash({1, 4, 12}, "tin", kOfTin); }
TEST(Edits, TenThousandHashAlikeOnFiveToEightRanks) { expectHash({5, 6, 7, 8}, "", kOfSpheres); }
TEST(Edits, TenThousandHashAlikeOnNineToTwelveRanks) { expectHash({9, 10, 11, 12}, "", kOfSpheres); }

}  // namespace
