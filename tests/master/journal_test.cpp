// SPDX-License-Identifier: Apache-2.0
#include "master/journal.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "files/input_error.hpp"
#include "tests/support/sand_samples.hpp"

namespace {

class JournalFile : public testing::Test {
protected:
    void SetUp() override {
        file_ = std::filesystem::temp_directory_path() /
                (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".journal");
        std::filesystem::remove(file_);
    }
    void TearDown() override { std::filesystem::remove(file_); }

    /// Ten frames of a random hand, three steps each.
    std::vector<master::JournalFrame> writeSession(bool finished) {
        const sand::Scene scene = samples::flatScene(20, 10);
        std::mt19937 random(47);
        master::JournalWriter writer(file_, scene, "0123456789abcdef");
        std::vector<master::JournalFrame> frames;
        for (std::uint64_t frame = 0; frame < 10; ++frame) {
            master::JournalFrame& written = frames.emplace_back();
            written.frame = frame + 1;
            written.hashBefore = random();
            for (std::uint64_t i = 1; i <= 3; ++i) {
                written.steps.push_back(samples::randomStep(3 * frame + i, scene.rules, random));
            }
            writer.append(written);
        }
        if (finished) {
            writer.finish(30, 77);
        }
        return frames;
    }
    static void expectFrames(const std::vector<master::JournalFrame>& got,
                             const std::vector<master::JournalFrame>& expected, std::size_t count) {
        ASSERT_EQ(got.size(), count);
        for (std::size_t i = 0; i < count; ++i) {
            EXPECT_EQ(got[i].frame, expected[i].frame);
            EXPECT_EQ(got[i].hashBefore, expected[i].hashBefore);
            EXPECT_EQ(got[i].steps, expected[i].steps);
        }
    }
    std::filesystem::path file_;
};

TEST_F(JournalFile, GivesBackWhatWasWritten) {
    const auto frames = writeSession(true);
    const master::Journal journal = master::readJournal(file_);
    expectFrames(journal.frames, frames, 10);
    EXPECT_EQ(journal.buildId, "0123456789abcdef");
    ASSERT_TRUE(journal.end.has_value());
    EXPECT_EQ(journal.end->step, 30U);
    EXPECT_EQ(journal.end->hash, 77U);
    EXPECT_EQ(journal.tornBytes, 0);
}

TEST_F(JournalFile, KeepsWhatAnOperatorAskedFor) {
    const sand::Scene scene = samples::flatScene(20, 10);
    master::JournalFrame frame{1, 5, {}};
    for (const sand::Edit& edit : {sand::Edit::tuned({7, 11, 13, 17}), sand::Edit::loaded(files::Bytes(200'000, 9)),
                                   sand::Edit(sand::Edit::undo)}) {
        frame.steps.push_back({1, frame.steps.size() + 1, false, {}, edit});
    }
    {
        master::JournalWriter writer(file_, scene, "0123456789abcdef");
        writer.append(frame);
    }
    const master::Journal journal = master::readJournal(file_);
    ASSERT_EQ(journal.frames.size(), 1U);
    EXPECT_EQ(journal.frames[0].steps, frame.steps);
}

TEST_F(JournalFile, AFullDiskLeavesTheFramesBeforeWhole) {
    const sand::Scene scene = samples::flatScene(20, 10);
    std::mt19937 random(47);
    master::JournalWriter writer(file_, scene, "0123456789abcdef");
    const auto append = [&](std::uint64_t number) {
        writer.append({number, number, {samples::randomStep(number, scene.rules, random)}});
    };
    append(1);
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    rlimit small = before;
    small.rlim_cur = std::filesystem::file_size(file_) + 9;  // room for a part of the next record
    setrlimit(RLIMIT_FSIZE, &small);
    EXPECT_THROW(append(2), files::InputError);
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    const master::Journal journal = master::readJournal(file_);
    EXPECT_EQ(journal.frames.size(), 1U);
    EXPECT_EQ(journal.tornBytes, 0);
}

TEST_F(JournalFile, ATornTailLosesNothingButItself) {
    const auto frames = writeSession(false);
    const auto whole = std::filesystem::file_size(file_);
    const std::size_t before = master::readJournal(file_).frames.size();
    ASSERT_EQ(before, 10U);
    for (std::uintmax_t cut = 1; cut < 20; ++cut) {
        std::filesystem::resize_file(file_, whole - cut);
        const master::Journal journal = master::readJournal(file_);
        expectFrames(journal.frames, frames, 9);
        EXPECT_GT(journal.tornBytes, 0);
        EXPECT_FALSE(journal.end.has_value());
    }
}

TEST_F(JournalFile, RefusesDamageInItsMiddle) {
    writeSession(true);
    const auto size = static_cast<std::streamoff>(std::filesystem::file_size(file_));
    std::fstream stream(file_, std::ios::in | std::ios::out | std::ios::binary);
    const auto flip = [&](std::streamoff at) {
        stream.seekg(at);
        const int before = stream.get();
        stream.seekp(at);
        stream.put(static_cast<char>(before ^ 1));
        stream.flush();
    };
    // Whatever it is a part of: length, type, payload or checksum.
    for (std::streamoff at = size * 3 / 4; at < size * 3 / 4 + 100; ++at) {
        flip(at);
        EXPECT_THROW((void)master::readJournal(file_), files::InputError) << "byte " << at << " of " << size;
        flip(at);
    }
    EXPECT_NO_THROW((void)master::readJournal(file_));
}

TEST_F(JournalFile, KeepsTheJournalOfTheSessionBefore) {
    writeSession(false);
    const auto before = std::filesystem::file_size(file_);
    const std::filesystem::path kept = file_.string() + ".previous";
    const master::JournalWriter writer(file_, samples::flatScene(8, 8), "x");
    EXPECT_EQ(std::filesystem::file_size(kept), before);
    EXPECT_TRUE(master::readJournal(file_).frames.empty());
    std::filesystem::remove(kept);
}

TEST_F(JournalFile, RefusesWhatIsNoJournal) {
    EXPECT_THROW((void)master::readJournal(file_), files::InputError);
    std::ofstream(file_) << "certainly not";
    EXPECT_THROW((void)master::readJournal(file_), files::InputError);
    writeSession(true);
    std::fstream stream(file_, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(30);  // in the header
    stream.put('\x7f');
    stream.close();
    EXPECT_THROW((void)master::readJournal(file_), files::InputError);
}

TEST_F(JournalFile, ADiskThatRefusesIsNamed) {
    if (std::filesystem::exists("/dev/full")) {
        EXPECT_THROW(master::JournalWriter("/dev/full", samples::flatScene(8, 8), "x"), files::InputError);
    }
    EXPECT_THROW(master::JournalWriter("/nowhere/session.journal", samples::flatScene(8, 8), "x"), files::InputError);
}

// Sessions of spheres are written as they were before there were other tools (tests/sand/step_test.cpp), so that this
// file is one of version 3 but for the number.
TEST_F(JournalFile, ReadsOnesFromBeforeThereWereOtherTools) {
    const auto frames = writeSession(true);
    std::fstream stream(file_, std::ios::in | std::ios::out | std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    bytes[4] = 3;
    const auto lengthAt = [&](std::size_t at) {
        std::uint32_t length = 0;
        std::memcpy(&length, &bytes[at], sizeof length);
        return length;
    };
    const std::size_t scene = 8 + 4 + lengthAt(8), end = scene + 4 + lengthAt(scene);
    const std::uint64_t checksum = XXH3_64bits(bytes.data(), end);
    std::memcpy(&bytes[end], &checksum, sizeof checksum);
    stream.seekp(0);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    const master::Journal journal = master::readJournal(file_);
    expectFrames(journal.frames, frames, frames.size());
    EXPECT_TRUE(journal.end.has_value());
    EXPECT_EQ(journal.scene.rules.toolKind, sand::ToolKind::sphere);
}

// The version stands behind the four bytes of the name, and in front of all that a later one may change.
TEST_F(JournalFile, TellsTheVersionsItReads) {
    for (const auto& [version, complaint] : {std::pair{1, "a journal whose header is damaged"},
                                             {5, "a journal of version 5; this program reads 1 to 4"}}) {
        writeSession(true);
        std::fstream stream(file_, std::ios::in | std::ios::out | std::ios::binary);
        stream.seekp(4);
        stream.put(static_cast<char>(version));
        stream.close();
        try {
            (void)master::readJournal(file_);
            ADD_FAILURE() << version;
        } catch (const files::InputError& error) {
            EXPECT_NE(std::string(error.what()).find(complaint), std::string::npos) << error.what();
        }
    }
}

}  // namespace
