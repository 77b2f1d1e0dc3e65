// SPDX-License-Identifier: Apache-2.0
#include "journal/file_origin.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/input_error.hpp"
#include "host/version.hpp"
#include "master/journal/checkpoint.hpp"
#include "master/journal/journal.hpp"
#include "master/journal/saved_sand.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/processes/run_program.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

constexpr std::uint32_t kJournal = 0x4c4a5753, kCheckpoint = 0x50435753, kSand = 0x44535753;  // SWJL, SWCP, SWSD
constexpr std::uint32_t kAlgorithm = sand::kAlgorithmVersion;
constexpr const char* kTooOld = "written before release 0.2.0; no release reads it; run the session again";

/// Writes journals, checkpoints and saved sand, and returns the errors for files that this release does not read.
class OriginOfFiles : public test::FolderTest {
protected:
    [[nodiscard]] std::string nameOf(std::uint32_t magic) const {
        return (folder_ / (magic == kJournal      ? "x.journal"
                           : magic == kCheckpoint ? "x.checkpoint"
                                                  : "x.sand"))
            .string();
    }
    void write(std::uint32_t magic, const base::Bytes& bytes) const {
        std::ofstream(nameOf(magic), std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
    /// Writes a file that begins with this origin. The bytes after it must not matter.
    void begin(std::uint32_t magic, std::uint32_t format, std::uint32_t algorithm, const std::string& release) const {
        base::ByteWriter writer;
        for (const std::uint32_t number : {magic, format, algorithm}) {
            writer.put(number);
        }
        writer.putText(release);
        writer.putBytes(base::Bytes(100, 7));
        write(magic, writer.take());
    }
    /// Writes a whole file as this release does, and returns its bytes.
    [[nodiscard]] base::Bytes writeWhole(std::uint32_t magic) const {
        sand::Replica replica(scene_);
        const std::uint64_t hash = replica.stateHash();
        if (magic == kJournal) {
            const master::JournalWriter writer(nameOf(magic), scene_, "test");
        } else if (magic == kSand) {
            master::writeSavedSand(nameOf(magic), {place_, 0, hash, replica.copySand()->encode()});
        } else {
            write(magic, master::Checkpoint{1, "test", 2, 0, 0, 1, hash, replica.encodeState()}.encode());
        }
        std::ifstream stream(nameOf(magic), std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    /// Returns the error message for a file, without its name; an empty text if the file can be read.
    [[nodiscard]] std::string refusal(std::uint32_t magic) const {
        try {
            if (magic == kJournal) {
                (void)master::readJournal(nameOf(magic));
            } else if (magic == kSand) {
                (void)master::readSavedSand(nameOf(magic), place_, sand::Replica(scene_).sandReader());
            } else {
                (void)master::readCheckpoint(nameOf(magic));
            }
        } catch (const base::FormatError& error) {
            return error.what();  // of a checkpoint; the session adds the name and continues without this checkpoint
        } catch (const base::InputError& error) {
            const std::string line = error.what(), name = nameOf(magic) + ": ", end = "; nothing was loaded";
            EXPECT_TRUE(line.starts_with(name)) << line;
            EXPECT_EQ(line.ends_with(end), magic == kSand) << line;
            return line.substr(name.size(), line.size() - name.size() - (magic == kSand ? end.size() : 0));
        }
        return "";
    }

    struct Kind {
        std::uint32_t magic, format;
        std::uint32_t first;  // the first format with an origin
        std::string name;
    };
    const std::vector<Kind> kinds_{{kJournal, journal::kJournalVersion, 6, "journal"},
                                   {kCheckpoint, 2, 2, "checkpoint"},
                                   {kSand, 2, 2, "saved sand"}};
    const std::string here_{host::release()};
    const scene::Scene scene_ = samples::flatScene(20, 10);
    const master::SandPlace place_ = master::SandPlace::of(scene_);
};

TEST_F(OriginOfFiles, StandsAtTheirBeginningAndIsReadBack) {
    for (const Kind& kind : kinds_) {
        base::ByteWriter expected;
        for (const std::uint32_t number : {kind.magic, kind.format, kAlgorithm}) {
            expected.put(number);
        }
        expected.putText(here_);
        const base::Bytes bytes = writeWhole(kind.magic);
        EXPECT_TRUE(std::ranges::equal(std::span(bytes).first(expected.bytes().size()), expected.bytes())) << kind.name;
        EXPECT_EQ(refusal(kind.magic), "");
        base::ByteReader reader(bytes);
        const journal::FileKind same{kind.name, kind.magic, kind.format, kind.format};
        const journal::FileOrigin origin = journal::readOrigin(same, host::release(), reader);
        EXPECT_EQ(origin.format, kind.format);
        EXPECT_EQ(origin.algorithm, kAlgorithm);
        EXPECT_EQ(origin.release, here_);
        EXPECT_EQ(reader.rest().size(), bytes.size() - expected.bytes().size());
    }
    EXPECT_EQ(master::openJournal(nameOf(kJournal)).header().origin.release, here_);
}

TEST_F(OriginOfFiles, NamesTheReleaseThatReadsThem) {
    for (const Kind& kind : kinds_) {
        for (const auto& [format, algorithm] :
             {std::pair{kind.format + 1, kAlgorithm}, {kind.format, kAlgorithm + 1}, {kind.format + 1, 1U}}) {
            begin(kind.magic, format, algorithm, "9.8.7");
            EXPECT_EQ(refusal(kind.magic),
                      fmt::format("written by sandwall 9.8.7 ({} format {}, algorithm {}); this is {} (format {}, "
                                  "algorithm {}): use sandwall 9.8.7",
                                  kind.name, format, algorithm, here_, kind.format, kAlgorithm));
        }
    }
}

TEST_F(OriginOfFiles, OfAnotherBuildOfThisReleaseIsNotSentBackToIt) {
    begin(kJournal, journal::kJournalVersion, kAlgorithm + 1, here_);
    EXPECT_TRUE(refusal(kJournal).ends_with(fmt::format(": another build of {} wrote it, or it is damaged", here_)))
        << refusal(kJournal);
}

TEST_F(OriginOfFiles, OfBeforeTheFirstReleaseIsReadByNone) {
    for (const Kind& kind : kinds_) {
        for (std::uint32_t format = 0; format < kind.first; ++format) {
            begin(kind.magic, format, kAlgorithm, "");
            EXPECT_EQ(refusal(kind.magic), kTooOld) << kind.name << " " << format;
        }
    }
}

TEST_F(OriginOfFiles, ThatCannotBeReadIsNotQuoted) {
    for (const std::string& release : {std::string(), std::string("0.3\n0"), std::string(33, '1')}) {
        begin(kCheckpoint, 3, kAlgorithm, release);
        EXPECT_EQ(refusal(kCheckpoint), "its origin names no release");
    }
    for (const Kind& kind : kinds_) {
        write(kind.magic, base::Bytes(50, 'x'));
        EXPECT_EQ(refusal(kind.magic), fmt::format("not a Sandwall {} file", kind.name));
    }
}

TEST_F(OriginOfFiles, ForeignJournalsEndEveryQuestionWithOneLineAndStatusTwo) {
    const std::string file = nameOf(kJournal), made = (folder_ / "made").string();
    const std::string another = fmt::format(
        "written by sandwall 9.8.7 (journal format {}, algorithm {}); this is {} (format {}, algorithm "
        "{}): use sandwall 9.8.7",
        journal::kJournalVersion, kAlgorithm + 1, here_, journal::kJournalVersion, kAlgorithm);
    for (const bool old : {true, false}) {
        begin(kJournal, old ? 5 : journal::kJournalVersion, kAlgorithm + 1, "9.8.7");
        for (const std::string& question :
             {std::string(), std::string("--hash"), std::string("--verify"), "--export " + made, "--recover " + made}) {
            const support::Ran ran = support::runProgram("sandwall-replay", fmt::format("{} {}", file, question));
            EXPECT_EQ(ran.status, 2) << question;
            EXPECT_EQ(ran.output, fmt::format("sandwall-replay: {}: {}\n", file, old ? kTooOld : another)) << question;
        }
    }
    EXPECT_FALSE(std::filesystem::exists(made));
}

}  // namespace
