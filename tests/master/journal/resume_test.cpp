// SPDX-License-Identifier: Apache-2.0
#include "master/journal/resume.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "base/input_error.hpp"
#include "master/journal/checkpoint.hpp"
#include "master/journal/journal.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/support/folder_test.hpp"
#include "tests/support/sand_samples.hpp"

namespace {

/// Records a session of 40 steps, two per frame, with a checkpoint after every tenth step.
class Resume : public test::FolderTest {
protected:
    void SetUp() override {
        scene_.material.humidity = 0.25;
        master::JournalWriter writer(journal(), scene_, "test");
        record(writer, 20);
        hashes_.push_back(replica_.stateHash());
    }

    void record(master::JournalWriter& writer, int frames, std::uint32_t epoch = 1) {
        for (int i = 0; i < frames; ++i) {
            journal::JournalFrame written{++frame_, replica_.stateHash(), {}};
            for (int k = 0; k < 2; ++k) {
                hashes_.push_back(replica_.stateHash());
                written.steps.push_back(samples::wildStep(replica_.stepNumber() + 1, scene_.rules, random_));
                written.steps.back().epoch = epoch;
                replica_.apply(written.steps.back());
            }
            writer.append(written);
            if (replica_.stepNumber() % 10 == 0) {
                keepCheckpoint(writer.session());
            }
        }
    }
    void keepCheckpoint(std::uint64_t session) {
        const master::Checkpoint checkpoint{session, "test", scene_.rules.digest(), replica_.stepNumber(),
                                            frame_,  1,      replica_.stateHash(),  replica_.encodeState()};
        master::writeCheckpoint(journal(), checkpoint, 3);
    }
    [[nodiscard]] std::filesystem::path journal() const { return folder_ / "session.journal"; }
    /// Expects the same sand as after an undisturbed replay of all steps.
    void expectSand(std::uint64_t step, std::uint64_t checkpoint) const {
        master::RestoredSand restored = master::restoreSand(journal(), step);
        EXPECT_EQ(restored.replica.stepNumber(), step);
        EXPECT_EQ(restored.replica.stateHash(), hashes_[step]) << step;
        EXPECT_EQ(restored.checkpointStep, checkpoint) << step;
        EXPECT_EQ(restored.replayedSteps, step - checkpoint) << step;
    }
    void spoil(const std::filesystem::path& file, std::streamoff at) const {
        std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
        stream.seekg(at);
        const int before = stream.get();
        stream.seekp(at);
        stream.put(static_cast<char>(before ^ 4));
    }
    static std::string refusal(const std::filesystem::path& journal, const std::string& scene = "") {
        try {
            (void)master::readSession(journal, scene);
        } catch (const base::InputError& error) {
            return error.what();
        }
        return "not refused";
    }

    scene::Scene scene_ = samples::flatScene(40, 30);
    sand::Replica replica_{scene_};
    std::mt19937 random_{59};
    std::uint64_t frame_ = 0;
    std::vector<std::uint64_t> hashes_;  // state hashes after every step, from 0
};

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
    master::JournalWriter writer(master::readSession(journal(), "")->place, "test");
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
    const auto session = master::readSession(journal(), "");
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
    replica_.decodeState(session->state);
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
        master::JournalWriter writer(master::readSession(journal(), "")->place, "test");
        writer.finish(40, hashes_[40]);
    }
    const auto session = master::readSession(journal(), "");
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
        master::JournalWriter writer(master::readSession(journal(), "")->place, "test");
        writer.keep(wetter);
        record(writer, 1);
    }
    EXPECT_EQ(master::readSession(journal(), "")->material, wetter);
    const journal::Journal whole = master::readJournal(journal());
    EXPECT_EQ(whole.scene.material, scene_.material);
    ASSERT_EQ(whole.materials.size(), 1U);
    EXPECT_EQ(whole.materials[0].material, wetter);
    EXPECT_EQ(whole.materials[0].frame, whole.frames.size() - 1);
}

TEST_F(Resume, KnowsTheShareOfTheForceThatAnOperatorHasSetLast) {
    EXPECT_FALSE(master::readSession(journal(), "")->forceShare.has_value());
    const std::uint64_t before = master::readSession(journal(), "")->hash;
    {
        master::JournalWriter writer(master::readSession(journal(), "")->place, "test");
        writer.keep(journal::JournalForce{0.5});
        writer.keep(journal::JournalForce{0});
        writer.sync();
    }
    const auto session = master::readSession(journal(), "");
    EXPECT_EQ(session->forceShare, 0);
    EXPECT_EQ(session->hash, before) << "sand and hash do not know it";
    EXPECT_EQ(session->step, 40U);
}

TEST_F(Resume, ChecksTheHashesOnTheWay) {
    std::filesystem::remove_all(folder_ / "checkpoints");
    {
        master::JournalWriter writer(master::readSession(journal(), "")->place, "test");
        writer.append({21, hashes_[40] ^ 1, {samples::randomStep(41, scene_.rules, random_)}});
    }
    EXPECT_NE(refusal(journal()).find(fmt::format("after step 40 the session had {:016x}, the replay has {:016x}",
                                                  hashes_[40] ^ 1, hashes_[40])),
              std::string::npos)
        << refusal(journal());
}

TEST_F(Resume, RefusesAJournalWithAHoleInItsSteps) {
    {
        master::JournalWriter writer(master::readSession(journal(), "")->place, "test");
        writer.append({21, hashes_[40], {samples::randomStep(42, scene_.rules, random_)}});
    }
    EXPECT_NE(refusal(journal()).find("step 42 follows step 40"), std::string::npos) << refusal(journal());
}

TEST_F(Resume, RefusesADamagedJournalAndSaysWhatCanBeKept) {
    spoil(journal(), static_cast<std::streamoff>(std::filesystem::file_size(journal()) / 2));
    const std::string why = refusal(journal());
    EXPECT_NE(why.find("damaged at byte"), std::string::npos) << why;
    EXPECT_NE(why.find("everything before is intact; sandwall-replay"), std::string::npos) << why;
}

TEST_F(Resume, RefusesAnotherSceneThanTheSessions) {
    const std::filesystem::path file = folder_ / "scene.toml";
    std::ofstream(file) << "name = \"other\"\n[field]\ncolumns = 40\nrows = 30\n[terrain]\nheight = 0.2\n[material]\n"
                           "[tool]\nradius = 0.04\n";
    EXPECT_NE(refusal(journal(), file.string()).find("is not the scene of the session in"), std::string::npos)
        << refusal(journal(), file.string());
    const std::filesystem::path other = folder_ / "other" / "session.journal";
    std::filesystem::create_directories(other.parent_path());
    { master::JournalWriter writer(other, scene::loadScene(file), "test"); }
    EXPECT_EQ(refusal(other, file.string()), "not refused");
}

// A user may give the scene by another path than at the start, and an earlier build has written no statements.
TEST_F(Resume, TheFilesOfATerrainHaveTheirUnitsAgain) {
    std::ofstream(folder_ / "t.asc") << "ncols 3\nnrows 2\ncellsize 1\n1 2 3\n4 5 6\n";
    const std::filesystem::path file = folder_ / "scene.toml";
    std::ofstream(file) << "[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\"\n[material]\n[tool]\nradius = 1\n";
    scene::Scene scene = scene::loadScene(file);
    ASSERT_EQ(scene.statements.value().size(), 1U);
    const std::filesystem::path ours = folder_ / "ours" / "session.journal", old = folder_ / "old" / "session.journal";
    std::filesystem::create_directories(ours.parent_path());
    std::filesystem::create_directories(old.parent_path());
    { master::JournalWriter writer(ours, scene, "test"); }
    EXPECT_EQ(master::readSession(ours, "")->scene.statements, scene.statements);
    EXPECT_EQ(master::readJournal(ours).scene.statements, scene.statements);
    EXPECT_EQ(refusal(ours, (folder_ / "." / "scene.toml").string()), "not refused");
    scene.statements.reset();
    { master::JournalWriter writer(old, scene, "test"); }
    EXPECT_EQ(master::readSession(old, "")->scene.statements, std::nullopt);
    EXPECT_EQ(refusal(old, file.string()), "not refused");
}

// The heights of this scene would take 1 GiB.
TEST_F(Resume, RefusesASceneOfAnotherSizeBeforeItsHeightsAreMade) {
    const std::filesystem::path file = folder_ / "scene.toml";
    std::ofstream(file) << "[field]\ncolumns = 16384\nrows = 16384\n[terrain]\n[material]\n";
    const auto residentKilobytes = [] {
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        return usage.ru_maxrss;
    };
    const long before = residentKilobytes();
    EXPECT_NE(refusal(journal(), file.string()).find("is not the scene of the session in"), std::string::npos);
    EXPECT_LT(residentKilobytes() - before, 100'000);
}

// Two sessions that write one journal would each destroy the steps of the other.
TEST_F(Resume, RefusesASessionThatStillRuns) {
    const auto session = master::readSession(journal(), "");
    const master::JournalWriter running(session->place, "test");
    const auto size = std::filesystem::file_size(journal());
    try {
        const master::JournalWriter second(session->place, "test");
        ADD_FAILURE() << "not refused";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("another session writes it"), std::string::npos) << error.what();
    }
    EXPECT_EQ(std::filesystem::file_size(journal()), size);
}

// A session that ends while the next one starts may have written more steps than the next one has read.
TEST_F(Resume, CutsNothingThatWasWrittenSinceItWasRead) {
    const auto session = master::readSession(journal(), "");
    {
        master::JournalWriter running(session->place, "test");
        running.finish(session->step, session->hash);
    }
    const auto size = std::filesystem::file_size(journal());
    try {
        const master::JournalWriter second(session->place, "test");
        ADD_FAILURE() << "not refused";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("written since it was read"), std::string::npos) << error.what();
    }
    EXPECT_EQ(std::filesystem::file_size(journal()), size);
}

// The first new edit gets a higher number than all edits that are in a step. The torn step was never shown.
TEST_F(Resume, KnowsTheHighestNumberOfAnEditInAllEpochs) {
    const auto append = [this](std::uint64_t number, std::uint32_t epoch) {
        const auto session = master::readSession(journal(), "");
        master::JournalWriter writer(session->place, "test");
        journal::JournalFrame frame{++frame_, replica_.stateHash(), {}};
        frame.steps.push_back(samples::randomStep(replica_.stepNumber() + 1, scene_.rules, random_));
        frame.steps.back().epoch = epoch;
        frame.steps.back().edit = samples::withNumber(number, sand::Edit::settle);
        replica_.apply(frame.steps.back());
        writer.append(frame);
        writer.sync();
    };
    EXPECT_EQ(master::readSession(journal(), "")->lastEdit, 0U) << "these edits came from no operator";
    append(7, 2);
    append(300, 3);
    EXPECT_EQ(master::readSession(journal(), "")->lastEdit, 300U);
    append(301, 3);
    std::filesystem::resize_file(journal(), std::filesystem::file_size(journal()) - 5);
    EXPECT_EQ(master::readSession(journal(), "")->lastEdit, 300U);
}

// The operator's material is written before the step with its edit.
TEST_F(Resume, KnowsNoMaterialWhoseStepWasTornOff) {
    const scene::Material before = master::readSession(journal(), "")->material;
    {
        master::JournalWriter writer(master::readSession(journal(), "")->place, "test");
        scene::Material wetter = before;
        wetter.humidity = before.humidity == 0.5 ? 0.25 : 0.5;
        (void)writer.keep(wetter);
        writer.sync();
    }
    EXPECT_EQ(master::readSession(journal(), "")->material.humidity, before.humidity);
    EXPECT_TRUE(master::readJournal(journal()).materials.empty());
}

// The resumed session may take a frame without a material as its first. A material that the crash left without its step
// is not a material of this frame.
TEST_F(Resume, KnowsNoMaterialWhoseStepWasTornOffAlsoAfterASecondResume) {
    const scene::Material before = master::readSession(journal(), "")->material;
    {
        master::JournalWriter writer(master::readSession(journal(), "")->place, "test");
        scene::Material wetter = before;
        wetter.humidity = 0.5;
        ASSERT_NE(wetter, before);
        (void)writer.keep(wetter);
        record(writer, 1);
    }
    std::filesystem::resize_file(journal(), std::filesystem::file_size(journal()) - 5);  // tears off the frame alone
    const auto torn = master::readSession(journal(), "");
    ASSERT_EQ(torn->step, 40U);
    ASSERT_GT(torn->cutBytes, 0);
    replica_.decodeState(torn->state);
    {
        master::JournalWriter writer(torn->place, "test");
        writer.resume({torn->frame, {torn->step, torn->hash}, torn->cutBytes, "a crash"});
        record(writer, 1);
    }
    const auto again = master::readSession(journal(), "");
    EXPECT_EQ(again->step, 42U);
    EXPECT_EQ(again->material, before);
    EXPECT_TRUE(master::readJournal(journal()).materials.empty());
}

TEST_F(Resume, WithoutAJournalThereIsNothingToGoOnWith) {
    EXPECT_FALSE(master::readSession(folder_ / "nowhere" / "session.journal", "").has_value());
}

}  // namespace
