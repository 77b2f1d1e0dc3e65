// SPDX-License-Identifier: Apache-2.0
#include "lockstep/divergence.hpp"

#include <gtest/gtest.h>

#include "lockstep/healing.hpp"

namespace {

lockstep::Vote voteOf(const std::vector<std::uint64_t>& hashes) {
    std::vector<lockstep::Account> accounts;
    accounts.reserve(hashes.size());
    for (const std::uint64_t hash : hashes) {
        accounts.push_back({hash, 0, {}});
    }
    return lockstep::countVotes(accounts);
}

TEST(Vote, GoesToTheMajorityAndTheMasterHasOne) {
    EXPECT_EQ(voteOf({7, 3, 3}).rank, 1) << "the master is the odd one";
    EXPECT_EQ(voteOf({7, 3, 3}).agreeing, 2);
    EXPECT_FALSE(voteOf({7, 3, 3}).tie);
}

TEST(Vote, IsATieWhereNoneHasMoreThanHalf) {
    EXPECT_TRUE(voteOf({3, 3, 7, 8}).tie) << "two ranks with the same error are not a majority";
    EXPECT_FALSE(voteOf({3, 3, 7, 8, 3}).tie);
    EXPECT_TRUE(voteOf({7, 3}).tie);
    EXPECT_EQ(voteOf({7, 3}).rank, 0) << "without a majority the master's";
    EXPECT_TRUE(voteOf({9, 3, 3, 7, 7}).tie);
    EXPECT_TRUE(voteOf({1, 2, 3}).tie);
    EXPECT_FALSE(voteOf({5, 5, 5}).tie) << "hashes that agree when they are computed again";
}

TEST(Vote, ComparesMovementBesideTheSand) {
    const lockstep::Vote vote = lockstep::countVotes({{3, 8, {}}, {3, 9, {}}, {3, 9, {}}});
    EXPECT_EQ(vote.rank, 1);
    EXPECT_EQ(vote.agreeing, 2);
    EXPECT_FALSE(vote.tie);
    EXPECT_TRUE(lockstep::countVotes({{3, 8, {}}, {3, 9, {}}}).tie);
}

TEST(Remedy, SurvivesItsEncoding) {
    const lockstep::Remedy remedy{true, 3, {0, 2}};
    EXPECT_EQ(base::decoded<lockstep::Remedy>(base::encoded(remedy)), remedy);
    EXPECT_EQ(base::decoded<lockstep::Remedy>(base::encoded(lockstep::Remedy{})), lockstep::Remedy{});
}

}  // namespace
