// SPDX-License-Identifier: Apache-2.0
#include "master/journal/journal.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "base/input_error.hpp"
#include "scene/scene.hpp"
#include "tests/support/folder_test.hpp"
#include "tests/support/sand_samples.hpp"

namespace {

class JournalFile : public test::FolderTest {
protected:
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
    const std::filesystem::path file_ = folder_ / "session.journal";
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
    for (const sand::Edit& edit : {sand::Edit::tuned({7, 11, 13, 17}), sand::Edit::loaded(base::Bytes(200'000, 9)),
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
    EXPECT_THROW(append(2), base::InputError);
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    const master::Journal journal = master::readJournal(file_);
    EXPECT_EQ(journal.frames.size(), 1U);
    EXPECT_EQ(journal.tornBytes, 0);
}

// At every length that a file can have been cut to: refused within the header, else whole records and the rest counted.
TEST_F(JournalFile, CutAnywhereItKeepsEveryRecordBeforeTheCut) {
    std::vector<std::uintmax_t> ends;  // of the header, and of every frame
    const sand::Scene scene = samples::flatScene(20, 10);
    std::mt19937 random(48);
    std::vector<master::JournalFrame> frames;
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
        const master::Journal journal = master::readJournal(file_);
        expectFrames(journal.frames, frames, whole);
        EXPECT_EQ(journal.tornBytes, static_cast<std::int64_t>(cut - ends[whole])) << cut;
    }
}

/// Changes one bit of a file, and changes it back when it goes.
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

// Whatever the byte is a part of: header, length, type, payload or checksum.
TEST_F(JournalFile, RefusesAFlippedBitOfAnyByteBeforeItsLastRecord) {
    writeSession(true);
    const auto size = static_cast<std::streamoff>(std::filesystem::file_size(file_));
    const std::streamoff last = size - 29;  // the end: length, type, step, hash, checksum
    for (std::streamoff at = 0; at < last; ++at) {
        const Flipped flipped(file_, at, static_cast<int>(at % 8));
        EXPECT_THROW((void)master::readJournal(file_), base::InputError) << "byte " << at << " of " << size;
    }
    for (std::streamoff at = last; at < size; ++at) {
        const Flipped flipped(file_, at, static_cast<int>(at % 8));
        const master::Journal journal = master::readJournal(file_);
        EXPECT_EQ(journal.frames.size(), 10U) << "byte " << at << " of " << size;
        EXPECT_FALSE(journal.end.has_value());
        EXPECT_EQ(journal.tornBytes, 29);
    }
    EXPECT_NO_THROW((void)master::readJournal(file_));
}

// One record of a session put into the place of another's: each is whole, and the chain is not.
TEST_F(JournalFile, RefusesARecordThatWasLeftOut) {
    const sand::Scene scene = samples::flatScene(20, 10);
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
    stream.seekp(30);  // in the header
    stream.put('\x7f');
    stream.close();
    EXPECT_THROW((void)master::readJournal(file_), base::InputError);
}

TEST_F(JournalFile, ADiskThatRefusesIsNamed) {
    if (std::filesystem::exists("/dev/full")) {
        EXPECT_THROW(master::JournalWriter("/dev/full", samples::flatScene(8, 8), "x"), base::InputError);
    }
    EXPECT_THROW(master::JournalWriter("/nowhere/session.journal", samples::flatScene(8, 8), "x"), base::InputError);
}

// As programs of before there were parts wrote it: checksums that do not hang together, and no number of the session.
// Sessions of spheres are the same in versions 3 and 4 (tests/sand/model/step_test.cpp).
TEST_F(JournalFile, ReadsOnesFromBeforeThereWereParts) {
    const auto frames = writeSession(true);
    const sand::Scene scene = samples::flatScene(20, 10);
    for (const std::uint32_t version : {3U, 4U}) {
        base::ByteWriter writer;
        writer.put(std::uint32_t{0x4c4a5753});
        writer.put(version);
        writer.putText("0123456789abcdef");
        writer.putBlock(scene.encode());
        writer.put(XXH3_64bits(writer.bytes().data(), writer.bytes().size()));
        std::vector<master::JournalRecord> records(frames.begin(), frames.end());
        records.emplace_back(master::JournalEnd{30, 77});
        for (const master::JournalRecord& record : records) {
            std::uint64_t chain = 0;
            writer.putBytes(master::encodeRecord(record, chain));
        }
        const base::Bytes bytes = writer.take();
        std::ofstream(file_, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        const master::Journal journal = master::readJournal(file_);
        expectFrames(journal.frames, frames, frames.size());
        ASSERT_TRUE(journal.end.has_value());
        EXPECT_EQ(journal.end->hash, 77U);
        EXPECT_EQ(journal.scene.rules.toolKind, sand::ToolKind::sphere);
    }
}

// The version stands behind the four bytes of the name, and in front of all that a later one may change.
TEST_F(JournalFile, TellsTheVersionsItReads) {
    for (const auto& [version, complaint] : {std::pair{0, "a journal of version 0; this program reads 1 to 5"},
                                             {6, "a journal of version 6; this program reads 1 to 5"}}) {
        writeSession(true);
        std::fstream stream(file_, std::ios::in | std::ios::out | std::ios::binary);
        stream.seekp(4);
        stream.put(static_cast<char>(version));
        stream.close();
        try {
            (void)master::readJournal(file_);
            ADD_FAILURE() << version;
        } catch (const base::InputError& error) {
            EXPECT_NE(std::string(error.what()).find(complaint), std::string::npos) << error.what();
        }
    }
}

}  // namespace
