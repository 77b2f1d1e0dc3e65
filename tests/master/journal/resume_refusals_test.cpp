// SPDX-License-Identifier: Apache-2.0
// Journals and scenes that no session continues with.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>

#include "base/input_error.hpp"
#include "master/journal/journal.hpp"
#include "master/journal/resume.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/master/journal/resume_fixture.hpp"
#include "tests/support/journal/read_session.hpp"

namespace {

using test::Resume;

TEST_F(Resume, RefusesAJournalWithAHoleInItsSteps) {
    {
        master::JournalWriter writer(test::readSession(journal())->place, "test");
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
    scene.statements->front().file = "t.asc";  // a journal names no folder
    EXPECT_EQ(test::readSession(ours)->scene.statements, scene.statements);
    EXPECT_EQ(master::readJournal(ours).scene.statements, scene.statements);
    EXPECT_EQ(refusal(ours, (folder_ / "." / "scene.toml").string()), "not refused");
    scene.statements.reset();
    { master::JournalWriter writer(old, scene, "test"); }
    EXPECT_EQ(test::readSession(old)->scene.statements, std::nullopt);
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
    const auto session = test::readSession(journal());
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
    const auto session = test::readSession(journal());
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

}  // namespace
