// SPDX-License-Identifier: Apache-2.0
#include "master/session_record.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "master/journal/journal.hpp"
#include "master/measure/recovery.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/journal/read_session.hpp"
#include "tests/support/machine/small_disk.hpp"
#include "tests/support/sand/no_steps.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using master::ArrivedStep;

class Record : public test::FolderTest {
protected:
    master::SessionRecord open(master::RecordOptions options = {}) {
        return {folder_, std::move(options), scene_, {{"the master"}, {"h0"}, {""}}};
    }
    void show(master::SessionRecord& record) {
        std::mt19937 random(static_cast<unsigned>(frame_));
        std::vector<ArrivedStep> steps(1);
        steps[0].step = samples::randomStep(sand_.replica().stepNumber() + 1, scene_.rules, random);
        record.keep({++frame_, sand_.hash(), {steps[0].step}}, {});
        sand_.apply(frame_, steps, 0, source_);
        record.shown(clock_.swapped(static_cast<std::int64_t>(frame_) * 16'000'000), frame_, sand_, 1);
    }
    [[nodiscard]] bool has(const char* name) const { return std::filesystem::exists(folder_ / name); }

    const scene::Scene scene_ = samples::flatScene(32, 24);
    master::MasterSand sand_{sand::Replica(scene_)};
    master::FrameClock clock_{60};
    test::NoSteps source_;
    std::uint64_t frame_ = 0;
};

TEST_F(Record, HoldsEveryStepAndTheSandOfEach) {
    master::SessionRecord record = open();
    EXPECT_TRUE(record.hasRoom(0, sand_));
    EXPECT_FALSE(record.full());
    EXPECT_EQ(record.journalFile(), folder_ / "session.journal");
    for (int i = 0; i < 5; ++i) {
        show(record);
    }
    const std::unique_ptr<sand::Replica> sand = record.sandOfJournal(sand_, {});
    ASSERT_NE(sand, nullptr);
    EXPECT_EQ(sand->stateHash(), sand_.hash());
    record.finish(sand_, true);
    const journal::Journal journal = master::readJournal(folder_ / "session.journal");
    EXPECT_EQ(journal.frames.size(), 5U);
    ASSERT_TRUE(journal.end.has_value());
    EXPECT_EQ(journal.end->hash, sand_.hash());
    nlohmann::json status;
    record.describe(status);
    EXPECT_EQ(status, (nlohmann::json{{"journal", true},
                                      {"journal_policy", "required"},
                                      {"journal_state", "written"},
                                      {"checkpoints_failed", 0},
                                      {"restarts", 0}}));
    master::reportRecovery({}, folder_);
    master::reportRecovery({}, folder_);
    record.describe(status);
    EXPECT_EQ(status["restarts"], 2);
    EXPECT_EQ(record.summary().parts, 1U);
}

TEST_F(Record, LeavesTheJournalOfASessionThatDifferedWithoutAnEnd) {
    master::SessionRecord record = open();
    show(record);
    record.finish(sand_, false);
    EXPECT_FALSE(master::readJournal(folder_ / "session.journal").end.has_value());
}

TEST_F(Record, OfAReplayWritesNoJournal) {
    master::RecordOptions options;
    options.keepsJournal = false;
    master::SessionRecord record = open(options);
    EXPECT_TRUE(record.hasRoom(std::int64_t{1} << 60, sand_));
    show(record);
    record.finish(sand_, true);
    EXPECT_FALSE(has("session.journal"));
    EXPECT_EQ(record.journalFile(), std::filesystem::path());
    EXPECT_EQ(record.sandOfJournal(sand_, {}), nullptr);
    EXPECT_EQ(record.summary().state, "off");
}

TEST_F(Record, TakesNoStepsForWhichTheDiskHasNoRoom) {
    support::testOnSmallDisk(folder_, "size=4m", [this] {
        master::SessionRecord record = open();
        show(record);
        EXPECT_TRUE(record.hasRoom(1 << 20, sand_));
        EXPECT_FALSE(record.hasRoomForEdit(8 << 20, sand_));
        EXPECT_FALSE(record.full()) << "the edit is refused, and the sand is not stopped";
        EXPECT_FALSE(record.hasRoom(8 << 20, sand_)) << "for sand that is larger than the disk";
        EXPECT_TRUE(record.full());
        EXPECT_EQ(record.stops(), 1U);
        nlohmann::json told;
        record.describe(told);
        EXPECT_EQ(told["journal_state"], "no_room");
    });
}

TEST_F(Record, RemovesTheResultsOfAnEarlierSessionUnlessItGoesOn) {
    const auto leave = [&] {
        for (const char* name : {"summary.json", "failure.json", "tile_r1c1_left.png", "wall.png", "divergence.txt",
                                 "recoveries.jsonl", "notes.txt"}) {
            std::ofstream(folder_ / name) << "old";
        }
    };
    leave();
    {
        master::SessionRecord record = open();
        show(record);
        record.finish(sand_, true);
    }
    for (const char* gone :
         {"summary.json", "failure.json", "tile_r1c1_left.png", "wall.png", "divergence.txt", "recoveries.jsonl"}) {
        EXPECT_FALSE(has(gone)) << gone;
    }
    EXPECT_TRUE(has("notes.txt")) << "a file of the user";
    leave();
    master::RecordOptions options;
    options.resumed =
        std::make_shared<const master::ResumedSession>(*test::readSession(folder_ / "session.journal", ""));
    master::SessionRecord record = open(options);
    EXPECT_FALSE(has("summary.json"));
    EXPECT_FALSE(has("failure.json"));
    EXPECT_TRUE(has("divergence.txt")) << "it belongs to the same session";
    EXPECT_TRUE(has("recoveries.jsonl"));
}

}  // namespace
