// SPDX-License-Identifier: Apache-2.0
// The link between two parts of a journal.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/input_error.hpp"
#include "host/version.hpp"
#include "master/journal/file_parts.hpp"
#include "master/journal/journal.hpp"
#include "tests/master/journal/keeper_fixture.hpp"
#include "tests/support/journal/read_session.hpp"

namespace {

namespace fs = std::filesystem;

base::Bytes contentOf(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void put(const fs::path& file, const base::Bytes& bytes) {
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

class Chain : public test::KeeperTest {
protected:
    static constexpr std::int64_t kPart = 2000;  // [byte]

    void goOnUntil(std::uint32_t parts) {
        while (keeper_->parts() < parts) {
            ASSERT_TRUE(showFrame());
        }
    }
    [[nodiscard]] fs::path second() const { return master::partOf(journal(), 2); }
    [[nodiscard]] journal::JournalHeader headerOf(const fs::path& part) const {
        const base::Bytes bytes = contentOf(part);
        base::ByteReader reader(bytes);
        std::uint64_t chain = 0;
        return journal::decodeHeader(reader, host::release(), chain);
    }
    /// Returns the complaint about the journal, or "none".
    [[nodiscard]] std::string complaint() const {
        try {
            (void)master::readJournal(journal());
        } catch (const base::InputError& error) {
            return error.what();
        }
        return "none";
    }
    [[nodiscard]] std::string otherPart() const {
        return second().string() + ": does not continue session.journal; everything before is intact";
    }
};

// Both pasts have the same session, and the same number of steps before part 2. Only the checksum with which part 2
// continues tells them apart.
TEST_F(Chain, APartOfAnotherPastOfTheSameSessionIsRefused) {
    begin({.checkpointSeconds = 0, .partBytes = kPart});
    ASSERT_TRUE(showFrame());
    keeper_.reset();
    const base::Bytes common = contentOf(journal());
    const base::Bytes state = replica_.encodeState();
    const std::uint64_t frame = frame_;
    const auto past = [&](unsigned seed) {
        fs::remove(second());
        put(journal(), common);
        replica_.decodeState(state);
        frame_ = frame;
        random_.seed(seed);
        const auto resumed = test::readSession(journal());
        begin({.checkpointSeconds = 0, .partBytes = kPart}, &*resumed);
        goOnUntil(2);
        keeper_.reset();
        return contentOf(second());
    };
    const base::Bytes other = past(1);
    const base::Bytes own = past(2);
    ASSERT_EQ(complaint(), "none");
    put(second(), other);
    ASSERT_EQ(headerOf(second()).session, master::openJournal(journal()).header().session);
    ASSERT_EQ(headerOf(second()).part, 2U);
    EXPECT_EQ(complaint(), otherPart());
    put(second(), own);
    EXPECT_EQ(complaint(), "none");
}

TEST_F(Chain, SessionNumberAndChecksumOfTheNextPartAreEachChecked) {
    begin({.checkpointSeconds = 0, .partBytes = kPart});
    goOnUntil(2);
    keeper_.reset();
    const journal::JournalHeader right = headerOf(second());
    const auto with = [&](const journal::JournalHeader& header) {
        std::uint64_t chain = 0;
        put(second(), journal::encodeHeader(header, host::release(), chain));
        return complaint();
    };
    EXPECT_EQ(with(right), "none");
    journal::JournalHeader wrong = right;
    wrong.session ^= 1;
    EXPECT_EQ(with(wrong), otherPart());
    wrong = right;
    wrong.part = 3;
    EXPECT_EQ(with(wrong), otherPart());
    wrong = right;
    wrong.continues ^= std::uint64_t{1} << 63;
    EXPECT_EQ(with(wrong), otherPart());
}

// A part of an earlier session with the same name, which could not be renamed.
TEST_F(Chain, APartOfAnotherSessionBehindTheLastRecordIsNoPartOfThisOne) {
    begin({.checkpointSeconds = 0, .partBytes = kPart});
    goOnUntil(2);
    keeper_.reset();
    const base::Bytes earlier = contentOf(second());
    replica_ = sand::Replica(scene_);
    begin({.checkpointSeconds = 0});
    ASSERT_TRUE(showFrame());
    keeper_.reset();
    put(second(), earlier);
    EXPECT_EQ(complaint(), "none");
    EXPECT_EQ(master::readJournal(journal()).frames.size(), 1U);
}

}  // namespace
