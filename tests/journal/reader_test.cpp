// SPDX-License-Identifier: Apache-2.0
// The rules of the reader, for a journal in memory. tests/master/journal has them for files.
#include "journal/reader.hpp"

#include <gtest/gtest.h>

#include "base/input_error.hpp"
#include "tests/journal/journal_in_memory.hpp"
#include "tests/support/files/overlong.hpp"

namespace {

class MemoryJournal : public testing::Test {
protected:
    MemoryJournal() {
        for (std::uint64_t number = 1; number <= 6; ++number) {
            if (number == 4) {
                journal_.beginPart({3, 103});
            }
            journal::JournalFrame frame{number, 99 + number, {}};
            sand::Step& step = frame.steps.emplace_back();
            step.number = number;
            step.sweeps = 1;
            journal_.add(frame);
        }
        journal_.add(journal::JournalEnd{6, 106});
    }
    /// Returns the last step, and the message of an error behind it.
    std::string read(std::string_view release = "1.2.3") {
        std::uint64_t last = 0;
        try {
            journal::JournalReader reader = journal_.reader(release);
            while (const auto record = reader.next()) {
                if (const auto* frame = std::get_if<journal::JournalFrame>(&*record)) {
                    last = frame->steps.back().number;
                }
            }
            torn_ = reader.tornBytes();
        } catch (const base::InputError& error) {
            return std::to_string(last) + " " + error.what();
        }
        return std::to_string(last);
    }

    test::JournalInMemory journal_{samples::flatScene(8, 8)};
    std::int64_t torn_ = -1;
};

TEST_F(MemoryJournal, IsReadFromPartToPart) {
    EXPECT_EQ(read(), "6");
    EXPECT_EQ(torn_, 0);
}

TEST_F(MemoryJournal, EndsBeforeATornWrite) {
    base::Bytes& part = journal_.parts()[1];
    part.resize(part.size() - 1);
    EXPECT_EQ(read(), "6");
    EXPECT_GT(torn_, 0);
}

TEST_F(MemoryJournal, IsRefusedFromADamagedRecordOn) {
    base::Bytes& part = journal_.parts()[1];
    const std::string size = std::to_string(part.size());
    const std::size_t record = (part.size() - journal::kAroundPayload) / 2;
    part[record] ^= 1U;
    const std::string found = read();
    EXPECT_NE(found.find("folder/JOURNAL.2: damaged at byte "), std::string::npos) << found;
    EXPECT_NE(found.find(" of " + size + ": an incomplete record; everything before is intact"), std::string::npos)
        << found;
}

TEST_F(MemoryJournal, IsRefusedFromAPathOnThatNoStepHas) {
    test::JournalInMemory journal(samples::flatScene(8, 8));
    sand::Step step{.number = 1, .engaged = true, .path = {{0, 0, 0}}, .sweeps = 1};
    journal.add(journal::JournalFrame{1, 99, {step}});
    ++step.number;
    for (std::size_t i = 1; i < sand::kMaxPathPoints; ++i) {
        step.path.push_back({i % 2 == 0 ? -sand::kMaxProbe : sand::kMaxProbe, 0, 0});
    }
    journal.add(journal::JournalFrame{2, 100, {step}});
    journal_ = journal;
    const std::string found = read();
    EXPECT_EQ(found.find("1 folder/JOURNAL: damaged at byte "), 0U) << found;
    EXPECT_NE(found.find("step 2 has a path of "), std::string::npos) << found;
}

TEST_F(MemoryJournal, HasOneFormOfEachNumber) {
    // A frame's number, and the number of its steps. Then a step's epoch, number and sweeps, and the number of an edit.
    sand::Step step{.epoch = 3, .number = 1, .edit = samples::withNumber(7, sand::Edit::settle), .sweeps = 1};
    const base::Bytes body = [&step] {
        std::uint64_t chain = 0;
        const base::Bytes record = journal::encodeRecord(journal::JournalFrame{2, 99, {step}}, chain, std::nullopt);
        return base::Bytes(record.begin() + 4, record.end() - 8);  // without its length and its checksum
    }();
    const int refused = test::widenedNumbers(body, [](const base::Bytes& wide) {
        std::uint64_t chain = 0;
        const base::Bytes record = journal::encodeRecord(journal::decodeRecord(wide), chain, std::nullopt);
        return base::Bytes(record.begin() + 4, record.end() - 8);
    });
    EXPECT_EQ(refused, 2 + 4);
}

TEST_F(MemoryJournal, NamesAMissingPartWithoutItsFolder) {
    journal_.parts().pop_back();
    EXPECT_EQ(read(), "3 folder/JOURNAL: continues in JOURNAL.2, which is missing; everything before is intact");
}

TEST_F(MemoryJournal, IsRefusedIfAPartFollowsMissingRecords) {
    base::Bytes& part = journal_.parts()[0];
    part.resize(part.size() - 1);
    const std::string place = std::to_string(part.size() + 1 - journal::kAroundPayload - 4 - 8);
    EXPECT_EQ(read(), "3 folder/JOURNAL: cut off at byte " + place +
                          ", but JOURNAL.2 continues the session after missing records; everything before is intact");
}

TEST_F(MemoryJournal, ADevelopmentBuildOfTheSameReleaseIsNotNamedAsTheRemedy) {
    // The release that reads is given by the caller, and only changes the advice.
    journal_.parts()[0][4] ^= 1U;  // the format
    EXPECT_NE(read("1.2.3").find("another build of 1.2.3 wrote it"), std::string::npos) << read("1.2.3");
    EXPECT_NE(read("9.9.9").find("use sandwall 1.2.3"), std::string::npos) << read("9.9.9");
}

TEST(JournalVersion, BelongsToTheBytesOfAMaterial) {
    EXPECT_EQ(std::pair(journal::kJournalVersion, base::encoded(scene::Material()).size()),
              std::pair(10U, std::size_t{76}))
        << "raise the version, and write the bytes of record 5 into docs/journal.md";
}

}  // namespace
