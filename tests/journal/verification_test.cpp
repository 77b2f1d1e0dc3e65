// SPDX-License-Identifier: Apache-2.0
#include "journal/verification.hpp"

#include <gtest/gtest.h>

#include <random>

#include "base/input_error.hpp"
#include "tests/journal/journal_in_memory.hpp"
#include "tests/support/seed.hpp"

namespace {

/// Sessions whose frames have two steps each.
class Verified : public testing::Test {
protected:
    using Counts = journal::Verification::Counts;

    journal::JournalFrame frame(std::uint64_t number) {
        journal::JournalFrame frame{number, sand_.stateHash(), {}};
        for (int i = 0; i < 2; ++i) {
            frame.steps.push_back(samples::randomStep(sand_.stepNumber() + 1, scene_.rules, random_));
            sand_.apply(frame.steps.back());
        }
        return frame;
    }
    [[nodiscard]] journal::JournalEnd here() { return {sand_.stepNumber(), sand_.stateHash()}; }
    Counts verify() {
        journal::JournalReader reader = journal_.reader();
        journal::Verification verification("JOURNAL", sand::Replica(scene_));
        while (const auto record = reader.next()) {
            verification.take(*record, [this](sand::Replica& replica) { steps_.push_back(replica.stepNumber()); });
        }
        last_ = verification.replica().stateHash();
        return verification.counts();
    }

    const scene::Scene scene_ = samples::flatScene(32, 32);
    std::mt19937 random_{test::randomSeed()};
    sand::Replica sand_{scene_};
    test::JournalInMemory journal_{scene_};
    std::vector<std::uint64_t> steps_;
    std::uint64_t last_ = 0;
};

TEST_F(Verified, EveryHashOfAWholeSessionIsCompared) {
    for (std::uint64_t number = 1; number <= 12; ++number) {
        journal_.add(frame(number));
    }
    journal_.add(here());
    const Counts counts = verify();
    EXPECT_EQ(counts.records, 13U);
    EXPECT_EQ(counts.hashes, 13U);  // one before each frame, and that of the end
    EXPECT_EQ(counts.differing, 0U);
    EXPECT_FALSE(counts.firstDifference);
    EXPECT_EQ(counts.firstFrame, 1U);
    EXPECT_EQ(counts.lastFrame, 12U);
    EXPECT_TRUE(counts.end);
    EXPECT_EQ(last_, sand_.stateHash());
    ASSERT_EQ(steps_.size(), 24U);
    EXPECT_EQ(steps_.front(), 1U);
    EXPECT_EQ(steps_.back(), 24U);
}

TEST_F(Verified, TheFirstDifferenceIsKept) {
    journal::JournalFrame wrong = frame(1);
    journal_.add(wrong);
    const std::uint64_t right = sand_.stateHash();
    for (std::uint64_t number = 2; number <= 3; ++number) {
        wrong = frame(number);
        wrong.hashBefore ^= number;
        journal_.add(wrong);
    }
    const Counts counts = verify();
    EXPECT_EQ(counts.hashes, 3U);
    EXPECT_EQ(counts.differing, 2U);
    ASSERT_TRUE(counts.firstDifference);
    EXPECT_EQ(counts.firstDifference->recorded.step, 2U);
    EXPECT_EQ(counts.firstDifference->recorded.hash, right ^ 2U);
    EXPECT_EQ(counts.firstDifference->replayed, right);
    EXPECT_FALSE(counts.end);
}

TEST_F(Verified, HashesOfADoubtedMajorityDoNotCount) {
    journal_.add(frame(1));
    journal_.add(journal::JournalDoubt{1, {2, sand_.stateHash() + 1}});
    for (std::uint64_t number = 2; number <= 3; ++number) {
        journal::JournalFrame wrong = frame(number);
        wrong.hashBefore += 1;
        journal_.add(wrong);
    }
    journal_.add(journal::JournalChecked{3, here(), true});
    journal_.add(frame(4));
    const Counts counts = verify();
    EXPECT_EQ(counts.doubts, 1U);
    EXPECT_EQ(counts.outvoted, 1U);
    EXPECT_EQ(counts.hashes, 3U);  // before frames 1 and 4, and that of the check
    EXPECT_EQ(counts.differing, 0U);
}

// The session rests after step 2, and is killed after step 4, while it rests again.
TEST_F(Verified, AFrameWithoutStepsProvesTheSandAfterTheLastStep) {
    const auto rest = [this](std::uint64_t number, std::uint64_t error) {
        journal_.add(journal::JournalFrame{number, sand_.stateHash() ^ error, {}});
    };
    journal_.add(frame(1));
    rest(2, 0);
    journal_.add(frame(7200));
    rest(7201, 4);
    const Counts counts = verify();
    EXPECT_EQ(counts.hashes, 4U);
    EXPECT_EQ(counts.differing, 1U);
    ASSERT_TRUE(counts.firstDifference);
    EXPECT_EQ(counts.firstDifference->recorded.step, 4U);
    EXPECT_EQ(counts.firstDifference->replayed, sand_.stateHash());
    EXPECT_EQ(counts.lastFrame, 7201U);
    EXPECT_EQ(steps_.size(), 4U);
}

TEST_F(Verified, AMissingStepIsRefused) {
    journal_.add(frame(1));
    (void)frame(2);
    journal_.add(frame(3));
    EXPECT_THROW((void)verify(), base::InputError);
}

}  // namespace
