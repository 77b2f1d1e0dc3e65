// SPDX-License-Identifier: Apache-2.0
// A resume tells how far it is. The ranks wait as long as it gets further.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/master/journal/resume_fixture.hpp"

namespace {

using test::Resume;

TEST_F(Resume, TellsHowMuchOfTheJournalIsReadAndReplayed) {
    std::filesystem::remove_all(folder_ / "checkpoints");
    std::vector<double> read, replayed;
    const auto session = master::readSession(journal(), "",
                                             {.read = [&](double share) { read.push_back(share); },
                                              .replayed = [&](double share) { replayed.push_back(share); }});
    EXPECT_EQ(session->replayedSteps, 40U);
    EXPECT_EQ(read.size(), 20U + 1) << "of each record, and at the end";
    EXPECT_GE(replayed.size(), 40U) << "of each step";
    for (const auto* shares : {&read, &replayed}) {
        EXPECT_TRUE(std::is_sorted(shares->begin(), shares->end()));
        EXPECT_LT(shares->front(), 0.4) << "the header is read";
        EXPECT_LT(shares->at(shares->size() / 2), 0.8);
        EXPECT_EQ(shares->back(), 1);
    }
}

// Such a replay takes longer, and the ranks must not give up meanwhile.
TEST_F(Resume, TellsThatTheReplayBeginsAgainFromAnEarlierCheckpoint) {
    const std::uint64_t session = master::openJournal(journal()).header().session;
    std::filesystem::remove(master::checkpointFile(journal(), 40));
    replica_.corrupt(5, 5);
    replica_.audit(replica_.hashTiles().tileCount());
    ASSERT_NE(replica_.stateHash(), hashes_[40]);
    keepCheckpoint(session);
    {
        master::JournalWriter writer(master::readSession(journal(), "")->place, "test");
        writer.finish(40, hashes_[40]);
    }
    std::vector<double> shares;
    const auto resumed =
        master::readSession(journal(), "", {.replayed = [&](double share) { shares.push_back(share); }});
    EXPECT_EQ(resumed->hash, hashes_[40]);
    EXPECT_EQ(resumed->checkpointStep, 30U);
    int begun = 1;
    for (std::size_t i = 1; i < shares.size(); ++i) {
        begun += shares[i] < shares[i - 1] ? 1 : 0;
    }
    EXPECT_EQ(begun, 2);
    EXPECT_EQ(shares.back(), 1);
}

}  // namespace
