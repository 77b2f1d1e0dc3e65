// SPDX-License-Identifier: Apache-2.0
// Steps are on disk before they are shown: fdatasync follows the journal's records before the session continues.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "master/journal/journal.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/processes/run_program.hpp"

namespace {

/// Runs a program that writes three frames, with sync_log.cpp between it and the disk.
class Synced : public test::FolderTest {
protected:
    /// Returns the lines of the program and of sync_log in order of time. The call number `fails` of fdatasync fails;
    /// call 1 is for the header.
    std::vector<std::string> keep(const std::string& policy, int fails = 0) {
        const std::string log = (folder_ / "log").string();
        ran_ = support::runCommand("SANDWALL_SYNC_LOG=" + log + " SANDWALL_SYNC_FAILS=" + std::to_string(fails) +
                                   " LD_PRELOAD=" + support::linkTo("sync-log.so", folder_) + " " + "'" +
                                   support::pathOfProgram("keep_frames") + "' " + folder_.string() + " " + policy);
        std::vector<std::string> lines;
        std::ifstream stream(log);
        for (std::string line; std::getline(stream, line);) {
            lines.push_back(line);
        }
        return lines;
    }
    void expectFrames(std::size_t count) const {
        const journal::Journal journal = master::readJournal(folder_ / "session.journal");
        EXPECT_EQ(journal.frames.size(), count);
        EXPECT_EQ(journal.tornBytes, 0);
    }
    support::Ran ran_;
};

TEST_F(Synced, EveryFrameIsOnDiskBeforeTheSessionGoesOn) {
    const std::vector<std::string> lines = keep("required");
    ASSERT_EQ(ran_.status, 0) << ran_.output;
    ASSERT_EQ(lines.size(), 8U) << "a sync of the header, and one for each of three frames";
    EXPECT_TRUE(lines[0].starts_with("sync 1 ")) << lines[0];
    EXPECT_EQ(lines[1], "made");
    std::size_t before = 0;
    for (std::size_t frame = 1; frame <= 3; ++frame) {
        std::istringstream synced(lines[2 * frame]), kept(lines[2 * frame + 1]);
        std::string word;
        std::size_t number = 0, size = 0, then = 0;
        synced >> word >> number >> size;
        EXPECT_EQ(word, "sync");
        EXPECT_EQ(number, frame + 1);
        kept >> word >> then;
        EXPECT_EQ(word, "kept");
        EXPECT_EQ(size, then) << "the whole record was there when it was synced";
        EXPECT_GT(size, before);
        before = size;
    }
    expectFrames(3);
}

TEST_F(Synced, ADiskThatFailsToSyncEndsTheSessionBeforeTheFrame) {
    const std::vector<std::string> lines = keep("required", 3);
    EXPECT_EQ(ran_.status, 3) << ran_.output;
    ASSERT_FALSE(lines.empty());
    EXPECT_EQ(lines.back(), "refused");
    expectFrames(1);
}

TEST_F(Synced, WithBestEffortTheSessionGoesOnWithoutAJournal) {
    const std::vector<std::string> lines = keep("best-effort", 3);
    EXPECT_EQ(ran_.status, 0) << ran_.output;
    ASSERT_FALSE(lines.empty());
    EXPECT_TRUE(lines.back().starts_with("kept ") && lines.back().ends_with(" failed")) << lines.back();
    expectFrames(1);
}

TEST_F(Synced, AHeaderThatCannotBeSyncedIsNoJournal) {
    const std::vector<std::string> lines = keep("required", 1);
    EXPECT_EQ(ran_.status, 2) << ran_.output;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "session.journal"));
    ASSERT_EQ(lines.size(), 1U);
}

}  // namespace
