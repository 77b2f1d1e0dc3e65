// SPDX-License-Identifier: Apache-2.0
// Decisions of a majority, compared with a journal that the session continues to write.
#include "master/check/journal_check.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <random>
#include <thread>

#include "master/journal/journal.hpp"
#include "master/journal/keeper.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/journal/read_session.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

class Check : public test::FolderTest {
protected:
    void SetUp() override {
        keeper_.emplace(folder_, master::JournalOptions{.checkpointSeconds = 0}, scene_, nullptr, "", "test");
    }
    /// Shows a frame with a step.
    void showFrame() {
        const sand::Step step = samples::randomStep(replica_.stepNumber() + 1, scene_.rules, random_);
        keeper_->keep({++frame_, wall_.stateHash(), {step}}, {});
        replica_.apply(step);
        wall_.apply(step);
    }
    void showFrames(int frames) {
        for (int i = 0; i < frames; ++i) {
            showFrame();
        }
    }
    /// Makes the sand of the wall differ from the journal's.
    void spoil() {
        wall_.corrupt(3, 4, 12);
        wall_.audit(wall_.hashTiles().tileCount());
    }
    /// Makes only the movement of the wall differ from the journal's.
    void spoilMovement() { wall_.corruptMovement(3, 4); }
    [[nodiscard]] journal::JournalEnd shown() { return {wall_.stepNumber(), wall_.stateHash()}; }
    void decide() { check_.begin(frame_, {shown(), wall_.movementDigest()}); }
    /// Shows frames until the check is over, and returns the sand that the ranks must take. Shows a step in each frame
    /// while the check lets it.
    std::unique_ptr<sand::Replica> follow() {
        std::unique_ptr<sand::Replica> right;
        while (!right && check_.pending()) {
            if (!check_.holds()) {
                showFrame();
            } else {
                ++held_;
            }
            right = check_.rightSand(wall_.stepNumber());
            if (!right) {
                check_.look(++frame_, shown());
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return right;
    }
    [[nodiscard]] std::filesystem::path journal() const { return folder_ / "session.journal"; }

    scene::Scene scene_ = samples::flatScene(40, 30);
    sand::Replica replica_{scene_};  // of the journal
    sand::Replica wall_{scene_};     // of all ranks
    std::mt19937 random_{83};
    std::uint64_t frame_ = 0;
    int held_ = 0;  // frames in which the wall took no step
    bool hasJournal_ = true;
    std::vector<journal::JournalDoubt> doubts_;
    std::vector<journal::JournalChecked> checked_;
    std::optional<master::JournalKeeper> keeper_;
    master::Incidents incidents_;
    master::JournalCheck check_{{[this] { return hasJournal_ ? journal() : std::filesystem::path(); },
                                 [this](const journal::JournalDoubt& doubt) {
                                     doubts_.push_back(doubt);
                                     keeper_->doubt(doubt);
                                 },
                                 [this](const journal::JournalChecked& checked) {
                                     checked_.push_back(checked);
                                     keeper_->checked(checked);
                                 }},
                                folder_,
                                incidents_};
};

TEST_F(Check, AMajorityThatIsRightIsConfirmedBehindTheFrames) {
    showFrames(20);
    decide();
    EXPECT_TRUE(check_.pending());
    EXPECT_EQ(follow(), nullptr);
    EXPECT_EQ(held_, 0) << "the sand never waits for a majority that is right";
    EXPECT_EQ(incidents_.outvoted, 0U);
    EXPECT_FALSE(check_.failed());
    ASSERT_EQ(doubts_.size(), 1U);
    ASSERT_EQ(checked_.size(), 1U);
    EXPECT_FALSE(checked_[0].outvoted);
    EXPECT_EQ(checked_[0].sand.hash, wall_.stateHash());
}

TEST_F(Check, TheJournalOutvotesAMajorityThatIsWrong) {
    showFrames(20);
    spoil();
    decide();
    const std::unique_ptr<sand::Replica> right = follow();
    ASSERT_NE(right, nullptr);
    EXPECT_EQ(right->stepNumber(), wall_.stepNumber()) << "the ranks take it in the frame that they show";
    EXPECT_EQ(right->stateHash(), replica_.stateHash());
    EXPECT_TRUE(check_.taking());
    wall_ = *right;
    check_.taken(frame_, shown());
    EXPECT_FALSE(check_.pending());
    EXPECT_FALSE(check_.holds());
    EXPECT_EQ(incidents_.outvoted, 1U);
    ASSERT_EQ(checked_.size(), 1U);
    EXPECT_TRUE(checked_[0].outvoted);
    // Hashes of the wrong sand do not count. Hashes after the correction do.
    showFrames(5);
    keeper_->finish(shown());
    int doubted = 0;
    sand::Replica replayed(scene_);
    for (const journal::JournalFrame& frame : master::readJournal(journal()).frames) {
        doubted += frame.doubted ? 1 : 0;
        EXPECT_TRUE(frame.doubted || frame.hashBefore == replayed.stateHash()) << frame.frame;
        for (const sand::Step& step : frame.steps) {
            replayed.apply(step);
        }
    }
    EXPECT_GT(doubted, 0);
    EXPECT_EQ(master::restoreSand(journal(), replayed.stepNumber()).replica.stateHash(), replica_.stateHash());
}

// The heights are right, so that the hash does not tell.
TEST_F(Check, TheJournalOutvotesAMajorityWhoseMovementAloneIsWrong) {
    showFrames(20);
    spoilMovement();
    decide();
    const std::unique_ptr<sand::Replica> right = follow();
    ASSERT_NE(right, nullptr);
    EXPECT_EQ(right->movementDigest(), replica_.movementDigest());
    EXPECT_EQ(right->stateHash(), wall_.stateHash());
    wall_ = *right;
    check_.taken(frame_, shown());
    EXPECT_EQ(incidents_.outvoted, 1U);
}

// The session is killed between the wrong decision and the end of the check.
TEST_F(Check, AResumedSessionTakesTheSandOfTheJournalAndNamesTheMajority) {
    showFrames(20);
    spoil();
    const std::uint64_t step = wall_.stepNumber();
    keeper_->doubt({frame_, shown()});
    showFrames(15);
    keeper_.reset();
    const auto resumed = test::readSession(journal());
    ASSERT_TRUE(resumed.has_value());
    EXPECT_EQ(resumed->step, 35U);
    EXPECT_EQ(resumed->hash, replica_.stateHash());
    ASSERT_TRUE(resumed->outvoted.has_value());
    EXPECT_EQ(resumed->outvoted->majority.sand.step, step);
    check_.reportResumed(*resumed->outvoted);
    EXPECT_EQ(incidents_.outvoted, 1U);
    EXPECT_FALSE(check_.pending());
    // Once the session has resumed, the majority is no longer in doubt.
    keeper_.emplace(folder_, master::JournalOptions{.checkpointSeconds = 0}, scene_, &*resumed, "a kill", "test");
    wall_ = replica_;
    showFrames(3);
    keeper_->finish(shown());
    keeper_.reset();
    EXPECT_FALSE(test::readSession(journal())->outvoted.has_value());
}

TEST_F(Check, NoCheckpointHoldsTheSandOfAMajorityInDoubt) {
    keeper_.emplace(folder_, master::JournalOptions{.checkpointSeconds = 1e-9}, scene_, nullptr, "", "test");
    showFrames(3);
    keeper_->doubt({frame_, shown()});
    for (int i = 0; i < 20; ++i) {
        showFrame();
        keeper_->shown(wall_, frame_, 1, wall_.stateHash());
    }
    EXPECT_TRUE(keeper_->copyMs().empty());
    keeper_->checked({frame_, shown(), false});
    keeper_->shown(wall_, frame_, 1, wall_.stateHash());
    EXPECT_EQ(keeper_->copyMs().size(), 1U);
}

TEST_F(Check, ASessionThatEndsInDoubtGetsNoEnd) {
    showFrames(3);
    keeper_->doubt({frame_, shown()});
    keeper_->finish(shown());
    EXPECT_FALSE(master::readJournal(journal()).end.has_value());
}

TEST_F(Check, TheEndOfTheSessionWaitsForTheReplay) {
    showFrames(20);
    spoil();
    decide();
    check_.finish(frame_, shown(), std::chrono::minutes(2));
    EXPECT_TRUE(check_.failed()) << "no rank can take the journal's sand any more";
    EXPECT_EQ(check_.doubt(), "the replay has other sand, which the ranks could not take any more");
    EXPECT_FALSE(check_.pending());
}

TEST_F(Check, AJournalThatCannotBeReplayedConfirmsNothing) {
    showFrames(20);
    keeper_.reset();
    std::filesystem::create_directory(folder_ / "other");
    keeper_.emplace(folder_ / "other", master::JournalOptions{}, scene_, nullptr, "", "test");
    std::filesystem::resize_file(journal(), std::filesystem::file_size(journal()) / 2);
    decide();
    EXPECT_EQ(follow(), nullptr);
    EXPECT_TRUE(check_.failed());
    EXPECT_EQ(check_.doubt().find("its journal could not be replayed: "), 0U) << check_.doubt();
    EXPECT_EQ(incidents_.outvoted, 0U);
}

TEST_F(Check, OfALaterDecisionEndsTheDoubtOfAnEarlierOne) {
    showFrames(20);
    const master::Decision decided{shown(), wall_.movementDigest()};
    const std::uint64_t frame = frame_;
    keeper_.reset();
    std::filesystem::create_directory(folder_ / "other");
    keeper_.emplace(folder_ / "other", master::JournalOptions{}, scene_, nullptr, "", "test");
    std::filesystem::rename(journal(), folder_ / "away");
    decide();
    EXPECT_EQ(follow(), nullptr);
    ASSERT_TRUE(check_.failed());
    std::filesystem::rename(folder_ / "away", journal());
    check_.begin(frame, decided);
    EXPECT_EQ(follow(), nullptr);
    EXPECT_FALSE(check_.failed()) << check_.doubt();
}

// The replay has not been looked at when the majority decides again. Its result is about the newer decision.
TEST_F(Check, OfANewerDecisionIsNotEndedByTheOlderOne) {
    showFrames(20);
    decide();
    showFrames(5);
    spoil();
    decide();
    EXPECT_EQ(doubts_.size(), 2U);
    const std::unique_ptr<sand::Replica> right = follow();
    ASSERT_NE(right, nullptr) << "the newer decision was wrong";
    EXPECT_TRUE(checked_.empty()) << "no confirmation between the decisions";
}

TEST_F(Check, WithoutAJournalTheMajorityDecides) {
    hasJournal_ = false;
    decide();
    EXPECT_FALSE(check_.pending());
    EXPECT_TRUE(doubts_.empty());
}

}  // namespace
