// SPDX-License-Identifier: Apache-2.0
#include "master/journal/resume.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "base/input_error.hpp"
#include "master/journal/checkpoint.hpp"
#include "master/journal/journal.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/master/journal/resume_fixture.hpp"
#include "tests/support/journal/read_session.hpp"

namespace {

using test::Resume;

TEST_F(Resume, FindsTheSandAfterAnyStepFromTheNewestCheckpointBefore) {
    EXPECT_EQ(master::checkpointsOf(journal()), (std::vector<std::uint64_t>{40, 30, 20}));  // older: removed
    for (std::uint64_t step = 0; step <= 40; ++step) {
        expectSand(step, step >= 20 ? step / 10 * 10 : 0);
    }
    EXPECT_THROW((void)master::restoreSand(journal(), 41), base::InputError);
}

TEST_F(Resume, LeavesOutACheckpointThatIsDamagedAnywhere) {
    const std::filesystem::path newest = master::checkpointFile(journal(), 40);
    const auto size = static_cast<std::streamoff>(std::filesystem::file_size(newest));
    for (std::streamoff at = 0; at < size; ++at) {
        spoil(newest, at);
        EXPECT_THROW((void)master::readCheckpoint(newest), base::FormatError) << at << " of " << size;
        if (at % 97 == 0) {
            expectSand(40, 30);
        }
        spoil(newest, at);
    }
    expectSand(40, 40);
    for (std::uintmax_t cut = static_cast<std::uintmax_t>(size); cut-- > 0;) {
        std::filesystem::resize_file(newest, cut);
        EXPECT_THROW((void)master::readCheckpoint(newest), base::FormatError) << cut;
    }
    expectSand(40, 30);
}

// The checkpoint is whole, has the right checksum and belongs to the session. But its sand differs from the journal's.
TEST_F(Resume, LeavesOutACheckpointOfOtherSand) {
    const std::uint64_t session = master::openJournal(journal()).header().session;
    replica_ = master::restoreSand(journal(), 39).replica;
    replica_.apply({.epoch = 1, .number = 40, .engaged = true, .path = {{999, 999, -99}, {5000, 5000, -99}}});
    ASSERT_NE(replica_.stateHash(), hashes_[40]);
    keepCheckpoint(session);
    std::filesystem::remove(master::checkpointFile(journal(), 30));
    master::JournalWriter writer(test::readSession(journal())->place, "test");
    writer.finish(40, hashes_[40]);
    expectSand(40, 20);
}

TEST_F(Resume, LeavesOutACheckpointOfAnotherSession) {
    const std::filesystem::path copy = folder_ / "copy" / "session.journal";
    std::filesystem::create_directories(copy.parent_path());
    { master::JournalWriter again(copy, scene_, "test"); }
    std::filesystem::copy(folder_ / "checkpoints", folder_ / "copy" / "checkpoints");
    EXPECT_EQ(master::restoreSand(copy, 0).checkpointStep, 0U);
    // At step 0 both sessions have the same sand. Only the session's number is different.
    std::filesystem::rename(master::checkpointFile(copy, 40), master::checkpointFile(copy, 0));
    EXPECT_EQ(master::restoreSand(copy, 0).replica.stepNumber(), 0U);
}

TEST_F(Resume, GoesOnWithTheNextStepInTheSameJournal) {
    // Cuts off a part of the last frame.
    std::filesystem::resize_file(journal(), std::filesystem::file_size(journal()) - 5);
    const auto session = test::readSession(journal());
    ASSERT_TRUE(session.has_value());
    EXPECT_EQ(session->step, 38U);
    EXPECT_EQ(session->hash, hashes_[38]);
    EXPECT_EQ(session->frame, 19U);
    EXPECT_EQ(session->epoch, 1U);
    EXPECT_GT(session->cutBytes, 0);
    EXPECT_EQ(session->checkpointStep, 30U);
    EXPECT_EQ(session->replayedSteps, 8U);
    EXPECT_EQ(session->scene.encode(), scene_.encode());
    EXPECT_EQ(session->material, scene_.material);

    replica_ = sand::Replica(session->scene);
    replica_.decodeState(session->sand->encodeState());
    EXPECT_EQ(replica_.stateHash(), hashes_[38]);
    hashes_.resize(38);
    frame_ = session->frame;
    {
        master::JournalWriter writer(session->place, "test");
        writer.resume({session->frame, {session->step, session->hash}, session->cutBytes, "a test"});
        record(writer, 6, session->epoch + 1);
        writer.finish(replica_.stepNumber(), replica_.stateHash());
    }
    hashes_.push_back(replica_.stateHash());
    const journal::Journal journal = master::readJournal(this->journal());
    EXPECT_EQ(journal.frames.size(), 25U);
    EXPECT_EQ(journal.tornBytes, 0);
    ASSERT_EQ(journal.resumes.size(), 1U);
    EXPECT_EQ(journal.resumes[0].failure, "a test");
    EXPECT_EQ(journal.resumes[0].cutBytes, session->cutBytes);
    ASSERT_TRUE(journal.end.has_value());
    EXPECT_FALSE(std::filesystem::exists(this->journal().string() + ".previous"));
    // Replays from the beginning. The checkpoints of steps that were made twice must not be used.
    std::filesystem::remove_all(folder_ / "checkpoints");
    expectSand(50, 0);
}

TEST_F(Resume, AnEndedSessionGoesOnAndItsEndCountsNoMore) {
    {
        master::JournalWriter writer(test::readSession(journal())->place, "test");
        writer.finish(40, hashes_[40]);
    }
    const auto session = test::readSession(journal());
    ASSERT_TRUE(session.has_value());
    EXPECT_EQ(session->step, 40U);
    {
        master::JournalWriter writer(session->place, "test");
        writer.resume({session->frame, {40, hashes_[40]}, 0, ""});
    }
    EXPECT_FALSE(master::readJournal(journal()).end.has_value());
}

TEST_F(Resume, KnowsWhatTheOperatorMadeOfTheMaterial) {
    scene::Material wetter = scene_.material;
    wetter.humidity = 0.75;
    wetter.wetTalus = 51;
    wetter.toolKind = sand::ToolKind::ellipse;
    wetter.toolWidth = 0.5;
    {
        master::JournalWriter writer(test::readSession(journal())->place, "test");
        writer.keep(wetter);
        record(writer, 1);
    }
    EXPECT_EQ(test::readSession(journal())->material, wetter);
    const journal::Journal whole = master::readJournal(journal());
    EXPECT_EQ(whole.scene.material, scene_.material);
    ASSERT_EQ(whole.materials.size(), 1U);
    EXPECT_EQ(whole.materials[0].material, wetter);
    EXPECT_EQ(whole.materials[0].frame, whole.frames.size() - 1);
}

TEST_F(Resume, KnowsTheShareOfTheForceThatAnOperatorHasSetLast) {
    EXPECT_FALSE(test::readSession(journal())->forceShare.has_value());
    const std::uint64_t before = test::readSession(journal())->hash;
    {
        master::JournalWriter writer(test::readSession(journal())->place, "test");
        writer.keep(journal::JournalForce{0.5});
        writer.keep(journal::JournalForce{0});
        writer.sync();
    }
    const auto session = test::readSession(journal());
    EXPECT_EQ(session->forceShare, 0);
    EXPECT_EQ(session->hash, before) << "sand and hash do not know it";
    EXPECT_EQ(session->step, 40U);
}

TEST_F(Resume, ChecksTheHashesOnTheWay) {
    std::filesystem::remove_all(folder_ / "checkpoints");
    {
        master::JournalWriter writer(test::readSession(journal())->place, "test");
        writer.append({21, hashes_[40] ^ 1, {samples::randomStep(41, scene_.rules, random_)}});
    }
    EXPECT_NE(refusal(journal()).find(fmt::format("after step 40 the session had {:016x}, the replay has {:016x}",
                                                  hashes_[40] ^ 1, hashes_[40])),
              std::string::npos)
        << refusal(journal());
}

// A session was killed while nothing moved. Its last record is a frame without steps.
TEST_F(Resume, ContinuesSandThatRestsAndChecksItsHash) {
    const auto rest = [this](std::uint64_t hash) {
        master::JournalWriter writer(test::readSession(journal())->place, "test");
        writer.append({++frame_, hash, {}});
    };
    rest(hashes_[40]);
    const auto session = test::readSession(journal());
    EXPECT_EQ(session->step, 40U);
    EXPECT_EQ(session->frame, 21U) << "frames continue after the one in which the rest began";
    EXPECT_EQ(session->hash, hashes_[40]);
    {
        master::JournalWriter writer(session->place, "test");
        hashes_.pop_back();  // record() adds it again
        record(writer, 1);
        hashes_.push_back(replica_.stateHash());
    }
    expectSand(40, 40);
    expectSand(42, 40);
    rest(replica_.stateHash() ^ 1);
    EXPECT_NE(refusal(journal()).find("after step 42 the session had "), std::string::npos) << refusal(journal());
}

// The first new edit gets a higher number than all edits that are in a step. The torn step was never shown.
TEST_F(Resume, KnowsTheHighestNumberOfAnEditInAllEpochs) {
    const auto append = [this](std::uint64_t number, std::uint32_t epoch) {
        const auto session = test::readSession(journal());
        master::JournalWriter writer(session->place, "test");
        journal::JournalFrame frame{++frame_, replica_.stateHash(), {}};
        frame.steps.push_back(samples::randomStep(replica_.stepNumber() + 1, scene_.rules, random_));
        frame.steps.back().epoch = epoch;
        frame.steps.back().edit = samples::withNumber(number, sand::Edit::settle);
        replica_.apply(frame.steps.back());
        writer.append(frame);
        writer.sync();
    };
    EXPECT_EQ(test::readSession(journal())->lastEdit, 0U) << "these edits came from no operator";
    append(7, 2);
    append(300, 3);
    EXPECT_EQ(test::readSession(journal())->lastEdit, 300U);
    append(301, 3);
    std::filesystem::resize_file(journal(), std::filesystem::file_size(journal()) - 5);
    EXPECT_EQ(test::readSession(journal())->lastEdit, 300U);
}

// The operator's material is written before the step with its edit.
TEST_F(Resume, KnowsNoMaterialWhoseStepWasTornOff) {
    const scene::Material before = test::readSession(journal())->material;
    {
        master::JournalWriter writer(test::readSession(journal())->place, "test");
        scene::Material wetter = before;
        wetter.humidity = before.humidity == 0.5 ? 0.25 : 0.5;
        (void)writer.keep(wetter);
        writer.sync();
    }
    EXPECT_EQ(test::readSession(journal())->material.humidity, before.humidity);
    EXPECT_TRUE(master::readJournal(journal()).materials.empty());
}

// The resumed session may take a frame without a material as its first. A material that the crash left without its step
// is not a material of this frame.
TEST_F(Resume, KnowsNoMaterialWhoseStepWasTornOffAlsoAfterASecondResume) {
    const scene::Material before = test::readSession(journal())->material;
    {
        master::JournalWriter writer(test::readSession(journal())->place, "test");
        scene::Material wetter = before;
        wetter.humidity = 0.5;
        ASSERT_NE(wetter, before);
        (void)writer.keep(wetter);
        record(writer, 1);
    }
    std::filesystem::resize_file(journal(), std::filesystem::file_size(journal()) - 5);  // tears off the frame alone
    const auto torn = test::readSession(journal());
    ASSERT_EQ(torn->step, 40U);
    ASSERT_GT(torn->cutBytes, 0);
    replica_.decodeState(torn->sand->encodeState());
    {
        master::JournalWriter writer(torn->place, "test");
        writer.resume({torn->frame, {torn->step, torn->hash}, torn->cutBytes, "a crash"});
        record(writer, 1);
    }
    const auto again = test::readSession(journal());
    EXPECT_EQ(again->step, 42U);
    EXPECT_EQ(again->material, before);
    EXPECT_TRUE(master::readJournal(journal()).materials.empty());
}

TEST_F(Resume, WithoutAJournalThereIsNothingToGoOnWith) {
    EXPECT_FALSE(test::readSession(folder_ / "nowhere" / "session.journal", "").has_value());
}

}  // namespace
