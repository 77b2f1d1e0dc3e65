// SPDX-License-Identifier: Apache-2.0
// The keeper keeps three checkpoints. A resume uses none of sand that is in doubt.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>
#include <vector>

#include "master/journal/checkpoint.hpp"
#include "master/journal/journal.hpp"
#include "tests/master/journal/keeper_fixture.hpp"
#include "tests/support/journal/read_session.hpp"

namespace {

using Steps = std::vector<std::uint64_t>;

class Checkpoints : public test::KeeperTest {
protected:
    static constexpr double kAlways = 1e-9;  // [s], so short that a checkpoint is always due

    /// Shows frames until `count` checkpoints have begun. Returns their steps.
    Steps begun(std::size_t count) {
        constexpr std::uint64_t kMostSteps = 20'000;
        Steps steps;
        while (steps.size() < count) {
            if (replica_.stepNumber() == kMostSteps || !showFrame()) {
                ADD_FAILURE() << steps.size() << " checkpoints have begun after step " << replica_.stepNumber();
                return Steps(count);
            }
            if (keeper_->copyMs().size() > steps.size()) {
                steps.push_back(replica_.stepNumber());
            }
            std::this_thread::yield();
        }
        return steps;
    }
    void end() {
        keeper_->finish({replica_.stepNumber(), replica_.stateHash()});
        keeper_.reset();
    }
    /// Shows frames with a step up to step `step`.
    void showUntil(std::uint64_t step) {
        while (replica_.stepNumber() < step) {
            ASSERT_TRUE(showFrame());
        }
    }
    void keepCheckpoint(sand::Replica& replica) const {
        master::writeCheckpoint(journal(),
                                {master::openJournal(journal()).header().session, "test", scene_.rules.digest(),
                                 replica.stepNumber(), frame_, 1, replica.stateHash(), replica.encodeState()},
                                3);
    }
    [[nodiscard]] journal::JournalEnd here() { return {replica_.stepNumber(), replica_.stateHash()}; }
};

// The end of a session leaves out a checkpoint that takes too long.
TEST_F(Checkpoints, AFileThatIsLeftOutLeavesNothing) {
    begin({});
    ASSERT_TRUE(showFrame());
    const auto stop = [](double) { throw std::runtime_error("it is left out"); };
    master::Checkpoint checkpoint;
    checkpoint.step = 1;
    EXPECT_THROW(master::writeCheckpoint(journal(), checkpoint, replica_.copyState(), 3, stop), std::runtime_error);
    const std::filesystem::path folder = master::checkpointFile(journal(), 1).parent_path();
    EXPECT_TRUE(std::filesystem::is_empty(folder));
    master::writeCheckpoint(journal(), checkpoint, replica_.copyState(), 3, [](double) {});
    EXPECT_EQ(master::checkpointsOf(journal()), Steps{1});
}

/// Returns the bytes of a file.
base::Bytes bytesOf(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// It is compressed into its file, so the lengths in it are written when what they are the lengths of is known.
TEST_F(Checkpoints, OneThatIsWrittenInPiecesHasTheBytesOfAWholeOne) {
    scene_ = samples::flatScene(700, 750);
    scene_.terrain = samples::randomField(700, 750, 1 << 24, random_);
    replica_ = sand::Replica(scene_);
    begin({});
    ASSERT_TRUE(showFrame());
    replica_.apply({1, 2, true, {{300 * sand::kProbePerCell, 300 * sand::kProbePerCell, 0}}});
    master::Checkpoint checkpoint{7, "test", 8, 2, 3, 1, replica_.stateHash(), {}};
    int stripes = 0;
    master::writeCheckpoint(journal(), checkpoint, replica_.copyState(), 3, [&stripes](double) { ++stripes; });
    EXPECT_GT(stripes, 3);
    checkpoint.state = replica_.encodeState();
    ASSERT_GT(checkpoint.state.size(), 3 * base::ByteWriter::kPiece);
    EXPECT_TRUE(bytesOf(master::checkpointFile(journal(), 2)) == checkpoint.encode());
    master::writeCheckpoint(journal(), checkpoint, 3);
    EXPECT_TRUE(bytesOf(master::checkpointFile(journal(), 2)) == checkpoint.encode());
}

// Sand at rest has a sixth of the stripes of a state with fluxes and a stroke.
TEST_F(Checkpoints, OneOfSandAtRestTellsHowMuchOfItIsWritten) {
    scene_ = samples::flatScene(1500, 1500);
    replica_ = sand::Replica(scene_);
    begin({});
    std::vector<double> shares;
    master::writeCheckpoint(journal(), {}, replica_.copyState(), 3, [&](double share) { shares.push_back(share); });
    ASSERT_GE(shares.size(), 4U);
    EXPECT_DOUBLE_EQ(shares[0], 0.3);
    EXPECT_DOUBLE_EQ(shares[1], 0.6);
    EXPECT_DOUBLE_EQ(shares[2], 0.9);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_EQ(shares.back(), 1);
}

// Steps change the sand while it is copied.
TEST_F(Checkpoints, OneOfALargeFieldHasTheStateOfTheFrameAtWhichItBegan) {
    scene_ = samples::flatScene(1200, 1000);
    static_assert(1200 * 1000 > master::JournalKeeper::kCopiedCells);
    replica_ = sand::Replica(scene_);
    begin({.checkpointSeconds = kAlways});
    ASSERT_TRUE(showFrame());
    const base::Bytes first = replica_.encodeState();
    keeper_->copyRest(replica_);
    while (keeper_->copyMs().size() < 2) {  // until the second one begins
        ASSERT_TRUE(showFrame());
    }
    const std::uint64_t second = replica_.stepNumber();
    const base::Bytes state = replica_.encodeState();
    ASSERT_TRUE(showFrame());
    ASSERT_TRUE(showFrame());
    end();
    ASSERT_EQ(master::checkpointsOf(journal()), (Steps{second, 1}));
    EXPECT_TRUE(master::readCheckpoint(master::checkpointFile(journal(), 1)).state == first);
    EXPECT_TRUE(master::readCheckpoint(master::checkpointFile(journal(), second)).state == state);
}

TEST_F(Checkpoints, OneWhoseCopyIsNotCompleteAtTheEndIsLeftOut) {
    scene_ = samples::flatScene(1200, 1000);
    replica_ = sand::Replica(scene_);
    begin({.checkpointSeconds = kAlways});
    ASSERT_TRUE(showFrame());
    end();
    EXPECT_EQ(master::checkpointsOf(journal()), Steps{});
}

// The newest two may be damaged.
TEST_F(Checkpoints, OfFourTheNewestThreeAreKept) {
    begin({.checkpointSeconds = kAlways});
    const Steps four = begun(4);
    end();
    EXPECT_EQ(master::checkpointsOf(journal()), (Steps{four[3], four[2], four[1]}));
    for (const std::size_t damaged : {3U, 2U}) {
        std::filesystem::resize_file(master::checkpointFile(journal(), four[damaged]), 20);
        EXPECT_EQ(master::restoreSand(journal(), replica_.stepNumber()).checkpointStep, four[damaged - 1]);
    }
}

TEST_F(Checkpoints, OneOfTheStepAtWhichTheSessionResumesStays) {
    begin({.checkpointSeconds = kAlways});
    const Steps two = begun(2);
    ASSERT_EQ(two[1], replica_.stepNumber()) << "it is of the last step";
    end();
    for (const char* resume : {"the first", "the second"}) {
        const auto resumed = test::readSession(journal());
        ASSERT_TRUE(resumed.has_value());
        EXPECT_EQ(resumed->checkpointStep, two[1]) << resume;
        EXPECT_EQ(resumed->replayedSteps, 0U) << resume;
        begin({.checkpointSeconds = 0}, &*resumed);
        EXPECT_EQ(keeper_->checkpointsBeyond(), 0U) << resume;
        EXPECT_EQ(master::checkpointsOf(journal()), (Steps{two[1], two[0]})) << resume;
        keeper_.reset();
    }
}

TEST_F(Checkpoints, OnlyThoseOfLaterStepsThanTheResumeAreSetAside) {
    begin({.checkpointSeconds = kAlways});
    const Steps three = begun(3);
    end();
    std::optional<test::ReadSession> resumed = test::readSession(journal());
    ASSERT_TRUE(resumed.has_value());
    resumed->step = three[1];
    begin({.checkpointSeconds = 0}, &*resumed);
    EXPECT_EQ(keeper_->checkpointsBeyond(), 1U);
    EXPECT_EQ(master::checkpointsOf(journal()), (Steps{three[1], three[0]}));
    EXPECT_TRUE(std::filesystem::exists(master::checkpointFile(journal(), three[2]).string() + ".beyond"));
}

TEST_F(Checkpoints, NoneIsMadeWhileTheSandIsInDoubt) {
    begin({.checkpointSeconds = kAlways});
    ASSERT_TRUE(showFrame());
    ASSERT_EQ(keeper_->copyMs().size(), 1U) << "one is due before the doubt";
    for (int i = 0; i < 10'000 && master::checkpointsOf(journal()).empty(); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    keeper_->doubt({frame_, here()});
    for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(showFrame());
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_EQ(keeper_->copyMs().size(), 1U);
    keeper_->checked({frame_, here(), false});
    ASSERT_TRUE(showFrame());
    EXPECT_EQ(keeper_->copyMs().size(), 2U);
}

// Repeated failures must not make each replay longer.
TEST_F(Checkpoints, OneIsDueAtOnceAfterADoubtAndAfterAResume) {
    begin({.checkpointSeconds = 1000});
    ASSERT_TRUE(showFrame());
    ASSERT_EQ(keeper_->copyMs().size(), 0U) << "the first is due after 1000 seconds";
    keeper_->doubt({frame_, here()});
    ASSERT_TRUE(showFrame());
    keeper_->checked({frame_, here(), false});
    ASSERT_TRUE(showFrame());
    EXPECT_EQ(keeper_->copyMs().size(), 1U) << "after a doubt";
    ASSERT_TRUE(showFrame());
    EXPECT_EQ(keeper_->copyMs().size(), 1U) << "the next one is not due";
    keeper_.reset();
    const auto resumed = test::readSession(journal());
    begin({.checkpointSeconds = 1000}, &*resumed);
    ASSERT_TRUE(showFrame());
    EXPECT_EQ(keeper_->copyMs().size(), 1U) << "after a resume";
}

// The wrong sand differs in a flux, which no hash shows, or in heights after a decision that was wrong. The checkpoint
// of it is whole and has the hash of its own sand.
TEST_F(Checkpoints, OneOfTheStepsThatAMajorityDecidedIsNotUsed) {
    begin({.checkpointSeconds = 0});
    showUntil(70);
    sand::Replica wrong = replica_;
    wrong.corrupt(20, 15, 12);
    wrong.audit(wrong.hashTiles().tileCount());
    keeper_->doubt({frame_, {wrong.stepNumber(), wrong.stateHash()}});
    showUntil(75);
    keeper_.reset();
    keepCheckpoint(wrong);
    const auto resumed = test::readSession(journal());
    ASSERT_TRUE(resumed.has_value());
    EXPECT_EQ(resumed->step, 75U);
    EXPECT_EQ(resumed->checkpointStep, 0U);
    EXPECT_EQ(resumed->hash, replica_.stateHash());
    ASSERT_TRUE(resumed->outvoted.has_value());
    EXPECT_EQ(resumed->outvoted->majority.sand.hash, wrong.stateHash());
}

// An error in a flux shows in the hash one step later, so that sand shortly before the decision may be wrong already.
TEST_F(Checkpoints, NoneOfTheSixtyStepsBeforeADoubtIsUsedUntilTheDoubtHasEnded) {
    begin({.checkpointSeconds = 0});
    for (const std::uint64_t step : {4U, 5U, 40U}) {
        showUntil(step);
        keepCheckpoint(replica_);
    }
    showUntil(64);
    keeper_->doubt({frame_, here()});
    ASSERT_TRUE(showFrame());
    keeper_->doubt({frame_, here()});  // a second decision does not end the first one's doubt
    ASSERT_TRUE(showFrame());
    const auto used = [this] { return test::readSession(journal())->checkpointStep; };
    EXPECT_EQ(used(), 4U) << "64 - 60";
    keeper_->checked({frame_, here(), false});
    ASSERT_TRUE(showFrame());
    EXPECT_EQ(used(), 40U) << "the sand was right";
    keeper_->doubt({frame_, here()});
    ASSERT_TRUE(showFrame());
    EXPECT_EQ(used(), 5U) << "67 - 60 = 7";
    keeper_.reset();
    const auto resumed = test::readSession(journal());
    begin({.checkpointSeconds = 0}, &*resumed);
    EXPECT_EQ(used(), 40U) << "the resumed session has the sand of the journal";
}

}  // namespace
