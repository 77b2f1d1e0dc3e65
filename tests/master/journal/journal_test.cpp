// SPDX-License-Identifier: Apache-2.0
#include "master/journal/journal.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <tuple>

#include "base/input_error.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/sand/sand_samples.hpp"
#include "tests/support/sand/tin_scene.hpp"

namespace {

class JournalFile : public test::FolderTest {
protected:
    /// Records ten frames of a random hand, with three steps each.
    std::vector<journal::JournalFrame> writeSession(bool finished) {
        const scene::Scene scene = samples::flatScene(20, 10);
        std::mt19937 random(47);
        master::JournalWriter writer(file_, scene, "0123456789abcdef");
        std::vector<journal::JournalFrame> frames;
        for (std::uint64_t frame = 0; frame < 10; ++frame) {
            journal::JournalFrame& written = frames.emplace_back();
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
    static void expectFrames(const std::vector<journal::JournalFrame>& got,
                             const std::vector<journal::JournalFrame>& expected, std::size_t count) {
        ASSERT_EQ(got.size(), count);
        for (std::size_t i = 0; i < count; ++i) {
            EXPECT_EQ(got[i].frame, expected[i].frame);
            EXPECT_EQ(got[i].hashBefore, expected[i].hashBefore);
            EXPECT_EQ(got[i].steps, expected[i].steps);
        }
    }
    const std::filesystem::path file_ = folder_ / "session.journal";
};

TEST_F(JournalFile, GivesBackWhatWasWritten) {
    const auto frames = writeSession(true);
    const journal::Journal journal = master::readJournal(file_);
    expectFrames(journal.frames, frames, 10);
    EXPECT_EQ(journal.buildId, "0123456789abcdef");
    ASSERT_TRUE(journal.end.has_value());
    EXPECT_EQ(journal.end->step, 30U);
    EXPECT_EQ(journal.end->hash, 77U);
    EXPECT_EQ(journal.tornBytes, 0);
}

TEST_F(JournalFile, KeepsWhatAnOperatorAskedFor) {
    const scene::Scene scene = samples::flatScene(20, 10);
    journal::JournalFrame frame{1, 5, {}};
    for (const sand::Edit& edit : {sand::Edit::tuned({7, 11, 13, {.radius = 17}}),
                                   sand::Edit::loaded(base::Bytes(200'000, 9)), sand::Edit(sand::Edit::undo)}) {
        frame.steps.push_back({1, frame.steps.size() + 1, false, {}, edit});
        frame.steps.back().sweeps = 8;
    }
    {
        master::JournalWriter writer(file_, scene, "0123456789abcdef");
        writer.append(frame);
    }
    const journal::Journal journal = master::readJournal(file_);
    ASSERT_EQ(journal.frames.size(), 1U);
    EXPECT_EQ(journal.frames[0].steps, frame.steps);
}

// The file is not damaged, but its steps are none of this sand.
TEST_F(JournalFile, RefusesSweepsThatNoStepHas) {
    const scene::Scene grid = samples::flatScene(20, 10), tin = samples::tinScene();
    for (const auto& [scene, right, wrong] :
         {std::tuple(&grid, 8, 0), {&grid, 8, sand::kMostSweeps + 1}, {&tin, 0, 3}}) {
        {
            master::JournalWriter writer(file_, *scene, "0123456789abcdef");
            for (const auto& [number, sweeps] : {std::pair(std::uint64_t{1}, right), {2, wrong}}) {
                sand::Step step{1, number, false, {}};
                step.sweeps = sweeps;
                writer.append({number, number, {step}});
            }
        }
        journal::JournalReader reader = master::openJournal(file_);
        ASSERT_TRUE(reader.next()) << "the step before it counts";
        const std::int64_t whole = reader.wholeBytes();
        try {
            (void)reader.next();
            ADD_FAILURE() << wrong;
        } catch (const base::InputError& error) {
            const std::string why = error.what();
            EXPECT_NE(why.find(std::to_string(wrong) + " sweeps"), std::string::npos) << why;
            EXPECT_NE(why.find("everything before is intact"), std::string::npos) << why;
        }
        EXPECT_EQ(reader.wholeBytes(), whole);
        std::filesystem::remove(file_);
    }
}

TEST_F(JournalFile, AFullDiskLeavesTheFramesBeforeWhole) {
    const scene::Scene scene = samples::flatScene(20, 10);
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
    EXPECT_THROW(append(2), base::InputError);
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    const journal::Journal journal = master::readJournal(file_);
    EXPECT_EQ(journal.frames.size(), 1U);
    EXPECT_EQ(journal.tornBytes, 0);
}

// Cuts the file at every length. A cut header is refused. Otherwise the whole records are read and the rest is counted.
TEST_F(JournalFile, CutAnywhereItKeepsEveryRecordBeforeTheCut) {
    std::vector<std::uintmax_t> ends;  // ends of the header and of every frame
    const scene::Scene scene = samples::flatScene(20, 10);
    std::mt19937 random(48);
    std::vector<journal::JournalFrame> frames;
    {
        master::JournalWriter writer(file_, scene, "0123456789abcdef");
        ends.push_back(std::filesystem::file_size(file_));
        for (std::uint64_t number = 1; number <= 6; ++number) {
            frames.push_back({number, random(), {samples::randomStep(number, scene.rules, random)}});
            writer.append(frames.back());
            ends.push_back(std::filesystem::file_size(file_));
        }
    }
    for (std::uintmax_t cut = ends.back(); cut-- > 0;) {
        std::filesystem::resize_file(file_, cut);
        if (cut < ends.front()) {
            EXPECT_THROW((void)master::readJournal(file_), base::InputError) << cut;
            continue;
        }
        const auto whole = static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), cut) - ends.begin()) - 1;
        const journal::Journal journal = master::readJournal(file_);
        expectFrames(journal.frames, frames, whole);
        EXPECT_EQ(journal.tornBytes, static_cast<std::int64_t>(cut - ends[whole])) << cut;
    }
}

/// Scope in which one bit of a file is flipped.
class Flipped {
public:
    Flipped(const std::filesystem::path& file, std::streamoff at, int bit) : file_(file), at_(at), bit_(bit) { flip(); }
    ~Flipped() { flip(); }
    Flipped(const Flipped&) = delete;
    Flipped& operator=(const Flipped&) = delete;

private:
    void flip() {
        std::fstream stream(file_, std::ios::in | std::ios::out | std::ios::binary);
        stream.seekg(at_);
        const int before = stream.get();
        stream.seekp(at_);
        stream.put(static_cast<char>(before ^ 1 << bit_));
    }
    std::filesystem::path file_;
    std::streamoff at_;
    int bit_;
};

// Flips one bit of each byte. The byte may belong to the header, or to a record's length, type, payload or checksum.
TEST_F(JournalFile, RefusesAFlippedBitOfAnyByteBeforeItsLastRecord) {
    writeSession(true);
    const auto size = static_cast<std::streamoff>(std::filesystem::file_size(file_));
    const std::streamoff last = size - 37;  // last record: length, type, mark, step, hash, checksum
    for (std::streamoff at = 0; at < last; ++at) {
        const Flipped flipped(file_, at, static_cast<int>(at % 8));
        EXPECT_THROW((void)master::readJournal(file_), base::InputError) << "byte " << at << " of " << size;
    }
    for (std::streamoff at = last; at < size; ++at) {
        const Flipped flipped(file_, at, static_cast<int>(at % 8));
        const journal::Journal journal = master::readJournal(file_);
        EXPECT_EQ(journal.frames.size(), 10U) << "byte " << at << " of " << size;
        EXPECT_FALSE(journal.end.has_value());
        EXPECT_EQ(journal.tornBytes, 37);
    }
    EXPECT_NO_THROW((void)master::readJournal(file_));
}

// Replaces a record by one of another session. Each record is whole, but the chain is broken.
TEST_F(JournalFile, RefusesARecordThatWasLeftOut) {
    const scene::Scene scene = samples::flatScene(20, 10);
    std::vector<std::uintmax_t> ends;
    {
        master::JournalWriter writer(file_, scene, "0123456789abcdef");
        for (std::uint64_t number = 1; number <= 4; ++number) {
            writer.append({number, number, {{.epoch = 1, .number = number, .engaged = false, .path = {}}}});
            ends.push_back(std::filesystem::file_size(file_));
        }
    }
    std::ifstream stream(file_, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    bytes.erase(ends[0], ends[1] - ends[0]);
    std::ofstream(file_, std::ios::binary) << bytes;
    EXPECT_THROW((void)master::readJournal(file_), base::InputError);
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
    EXPECT_THROW((void)master::readJournal(file_), base::InputError);
    std::ofstream(file_) << "certainly not";
    EXPECT_THROW((void)master::readJournal(file_), base::InputError);
    writeSession(true);
    std::fstream stream(file_, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(30);  // in the header
    const int byte = stream.get();
    stream.seekp(30);
    stream.put(static_cast<char>(byte ^ 1));
    stream.close();
    EXPECT_THROW((void)master::readJournal(file_), base::InputError);
}

TEST_F(JournalFile, ADiskThatRefusesIsNamed) {
    if (std::filesystem::exists("/dev/full")) {
        EXPECT_THROW(master::JournalWriter("/dev/full", samples::flatScene(8, 8), "x"), base::InputError);
    }
    EXPECT_THROW(master::JournalWriter("/nowhere/session.journal", samples::flatScene(8, 8), "x"), base::InputError);
}

}  // namespace
