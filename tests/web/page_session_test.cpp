// SPDX-License-Identifier: Apache-2.0
#include "web/replica/page_session.hpp"

#include <gtest/gtest.h>

#include <random>

#include "base/input_error.hpp"
#include "tests/journal/journal_in_memory.hpp"
#include "tests/support/seed.hpp"

namespace {

constexpr std::int64_t kMemory = 1 << 28;  // [byte]

/// A session of thirty steps in frames of two.
class OpenedSession : public testing::Test {
protected:
    void write(std::uint64_t wrong = 0) {
        for (std::uint64_t number = 1; number <= 15; ++number) {
            journal::JournalFrame frame{number, sand_.stateHash() + (number == wrong ? 1 : 0), {}};
            for (int i = 0; i < 2; ++i) {
                sand::Step step = samples::randomStep(sand_.stepNumber() + 1, scene_.rules, random_);
                step.engaged = (step.number / 5) % 2 == 0;
                if (step.number == 12) {
                    step.edit = samples::withNumber(1, sand::Edit::settle);
                }
                sand_.apply(step);
                hashes_.push_back(sand_.stateHash());
                frame.steps.push_back(std::move(step));
            }
            journal_.add(frame);
        }
        journal_.add(journal::JournalEnd{30, sand_.stateHash()});
    }
    web::PageSession open() { return {"JOURNAL", journal_.parts(), "1.2.3", kMemory}; }
    static std::string refusal(std::vector<base::Bytes> parts, std::string_view release, std::int64_t memory) {
        try {
            const web::PageSession session("JOURNAL", std::move(parts), release, memory);
        } catch (const base::InputError& error) {
            return error.what();
        }
        return "taken";
    }

    const scene::Scene scene_ = samples::flatScene(32, 32);
    std::mt19937 random_{test::randomSeed()};
    sand::Replica sand_{scene_};
    test::JournalInMemory journal_{scene_};
    std::vector<std::uint64_t> hashes_;  // after each step
};

TEST_F(OpenedSession, ComputesEveryStepOnceAndComparesEveryHash) {
    write();
    web::PageSession session = open();
    EXPECT_EQ(session.lastStep(), 30U);
    EXPECT_EQ(session.hashes(), 16U);
    EXPECT_EQ(session.shortcoming(), "");
    while (session.advance()) {
    }
    EXPECT_EQ(session.matches(), 16U);
    EXPECT_EQ(session.mismatches(), 0U);
    EXPECT_EQ(session.replica().stateHash(), hashes_.back());
}

TEST_F(OpenedSession, ComparesTheHashesOfSandThatRested) {
    const sand::Step step = samples::randomStep(1, scene_.rules, random_);
    journal_.add(journal::JournalFrame{1, sand_.stateHash(), {step}});
    sand_.apply(step);
    journal_.add(journal::JournalFrame{2, sand_.stateHash(), {}});
    journal_.add(journal::JournalFrame{900, sand_.stateHash() + 1, {}});
    web::PageSession session = open();
    EXPECT_EQ(session.lastStep(), 1U);
    EXPECT_EQ(session.hashes(), 3U);
    while (session.advance()) {
    }
    EXPECT_EQ(session.matches(), 2U);
    EXPECT_EQ(session.mismatches(), 1U);
}

TEST_F(OpenedSession, GoesOnFromAnyKeptStateAndCountsEachHashOnce) {
    write();
    web::PageSession session = open();
    std::vector<base::Bytes> states;
    while (session.advance()) {
        states.push_back(session.replica().encodeState());
    }
    for (const base::Bytes& state : states) {
        session.replica().decodeState(state);
        do {
            const std::uint64_t step = session.replica().stepNumber();
            ASSERT_EQ(session.replica().stateHash(), hashes_.at(step - 1)) << step;
        } while (session.stepOn());
        ASSERT_EQ(session.replica().stepNumber(), 30U);
    }
    EXPECT_EQ(session.matches(), 16U);
    EXPECT_EQ(session.mismatches(), 0U);
}

TEST_F(OpenedSession, CountsAHashThatDiffers) {
    write(7);
    web::PageSession session = open();
    while (session.advance()) {
    }
    EXPECT_EQ(session.matches(), 15U);
    EXPECT_EQ(session.mismatches(), 1U);
    session.replica().decodeState(sand::Replica(scene_).encodeState());
    while (session.stepOn()) {
    }
    EXPECT_EQ(session.matches(), 15U);
    EXPECT_EQ(session.mismatches(), 1U);
}

TEST_F(OpenedSession, CountsSandThatDiffersInALaterPassOnce) {
    write();
    web::PageSession session = open();
    while (session.advance()) {
    }
    sand::Replica other(scene_);
    other.corrupt(16, 16, 20);
    std::uint64_t once = 0;
    for (int pass = 0; pass < 2; ++pass) {
        session.replica().decodeState(other.encodeState());
        while (session.stepOn()) {
        }
        once = pass == 0 ? session.mismatches() : once;
    }
    EXPECT_GT(once, 0U);
    EXPECT_EQ(session.mismatches(), once);
}

TEST_F(OpenedSession, MarksStrokesAndEdits) {
    write();
    std::vector<std::pair<std::uint64_t, std::string_view>> marks;
    const web::PageSession session = open();
    for (const web::Mark& mark : session.marks()) {
        marks.emplace_back(mark.step, mark.what);
    }
    const std::vector<std::pair<std::uint64_t, std::string_view>> expected{
        {1, "stroke"}, {10, "stroke"}, {12, "settle"}, {20, "stroke"}, {30, "stroke"}};
    EXPECT_EQ(marks, expected);
}

TEST_F(OpenedSession, KnowsTheHumidityOfEachStep) {
    scene::Scene wet = scene_;
    wet.material.humidity = 0.25;
    journal_ = test::JournalInMemory(wet);
    scene::Material wetter = wet.material;
    wetter.humidity = 0.5;
    for (std::uint64_t number = 1; number <= 4; ++number) {
        if (number == 3) {
            journal_.add(wetter);
        }
        sand::Step step = samples::randomStep(number, scene_.rules, random_);
        journal_.add(journal::JournalFrame{number, sand_.stateHash(), {step}});
        sand_.apply(step);
    }
    web::PageSession session = open();
    const base::Bytes start = session.replica().encodeState();
    std::vector<double> humidity{session.humidity()};
    while (session.advance()) {
        humidity.push_back(session.humidity());
    }
    EXPECT_EQ(humidity,
              (std::vector<double>{0.25, 0.25, 0.25, 0.25, 0.5, 0.5}));  // the material is a record of its own
    session.replica().decodeState(start);
    EXPECT_EQ(session.humidity(), 0.25);
}

TEST_F(OpenedSession, HasWhatIsIntactBeforeDamage) {
    write();
    base::Bytes& part = journal_.parts()[0];
    const std::size_t header = test::JournalInMemory(scene_).parts()[0].size();
    part[header + (part.size() - header) / 2] ^= 1U;
    web::PageSession session = open();
    EXPECT_NE(session.shortcoming().find("damaged at byte"), std::string::npos) << session.shortcoming();
    EXPECT_GT(session.lastStep(), 4U);
    EXPECT_LT(session.lastStep(), 26U);
    while (session.advance()) {
    }
    EXPECT_EQ(session.mismatches(), 0U);
    EXPECT_EQ(session.replica().stateHash(), hashes_.at(session.lastStep() - 1));
}

TEST_F(OpenedSession, SaysWhatAPageCanDoAboutAJournalThatItDoesNotRead) {
    write();
    EXPECT_EQ(refusal({base::Bytes{}}, "1.2.3", kMemory).find("JOURNAL: is empty"), 0U);
    EXPECT_EQ(refusal({base::Bytes(100, 7)}, "1.2.3", kMemory), "JOURNAL: not a Sandwall journal file");
    EXPECT_NE(refusal(journal_.parts(), "1.2.3", 1000).find("and a page has 0 MiB"), std::string::npos);
    std::vector<base::Bytes> other = journal_.parts();
    other[0][4] ^= 1U;  // the format
    const std::string text = refusal(other, "9.9.9", kMemory);
    EXPECT_NE(text.find("written by sandwall 1.2.3"), std::string::npos) << text;
    EXPECT_NE(text.find("A page cannot run another release"), std::string::npos) << text;
    EXPECT_EQ(text.find("use sandwall"), std::string::npos) << text;
}

}  // namespace
