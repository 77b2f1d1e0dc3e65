// SPDX-License-Identifier: Apache-2.0
// Links and other special files in place of the files of a session. A file is opened once, and no link in a session's
// folder is followed.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <filesystem>

#include "host/version.hpp"
#include "master/journal/checkpoint.hpp"
#include "master/journal/file_parts.hpp"
#include "master/journal/journal.hpp"
#include "master/journal/resume.hpp"
#include "master/journal/saved_sand.hpp"
#include "tests/master/journal/keeper_fixture.hpp"
#include "tests/support/journal/read_session.hpp"
#include "tests/support/processes/blocked_child.hpp"
#include "tests/support/refusal.hpp"

namespace {

namespace fs = std::filesystem;

constexpr const char* kLink = ": is a link, which is not followed";

/// A session of several parts with checkpoints, in the folder `session`. Its files can be moved to the folder `aside`.
class Links : public test::KeeperTest {
protected:
    void SetUp() override {
        begin({.checkpointSeconds = 1e-9, .partBytes = 4000});
        while (keeper_->parts() < 3) {
            ASSERT_TRUE(showFrame());
        }
        keeper_->finish({replica_.stepNumber(), replica_.stateHash()});
        keeper_.reset();
        fs::create_directory(aside_);
    }
    [[nodiscard]] fs::path part(std::uint32_t number) const { return master::partOf(journal(), number); }
    /// Moves a file away, and leaves a link to it in its place.
    void becomesLink(const fs::path& file) const {
        fs::rename(file, aside_ / file.filename());
        fs::create_symlink(aside_ / file.filename(), file);
    }
    [[nodiscard]] std::string refusal() const {
        return test::refusalOf([this] { (void)master::readJournal(journal()); });
    }

    const fs::path aside_ = folder_ / "aside";
};

TEST_F(Links, InPlaceOfAJournalIsFollowedByNobodyWhoNamesTheFolder) {
    ASSERT_EQ(refusal(), "nothing");
    becomesLink(journal());
    const std::string line = journal().string() + kLink + "; name the journal itself";
    EXPECT_EQ(refusal(), line);
    EXPECT_EQ(test::refusalOf([this] { (void)test::readSession(journal()); }), line);
    EXPECT_EQ(test::refusalOf([this] { (void)master::restoreSand(journal(), 1); }), line);
    EXPECT_EQ(test::refusalOf([this] { (void)master::readJournal(master::journalAt(folder_)); }), line);
    fs::remove(aside_ / journal().filename());
    EXPECT_EQ(test::refusalOf([this] { (void)test::readSession(journal()); }), line) << "a link to nothing";
}

TEST_F(Links, ToAJournalMayBeNamedByAUser) {
    const fs::path named = folder_ / "named";
    fs::create_symlink(journal(), named);
    EXPECT_EQ(master::journalAt(named), fs::canonical(journal()));
    EXPECT_EQ(master::readJournal(master::journalAt(named)).frames.size(), replica_.stepNumber())
        << "the other parts are beside the journal";
    fs::create_directory_symlink(folder_, aside_ / "folder");
    EXPECT_EQ(master::readJournal(master::journalAt(aside_ / "folder")).frames.size(), replica_.stepNumber());
    fs::create_symlink(folder_ / "nothing", aside_ / "dangling");
    EXPECT_EQ(test::refusalOf([this] { (void)master::journalAt(aside_ / "dangling"); }),
              (aside_ / "dangling").string() + ": cannot be read (No such file or directory); check the path");
}

TEST_F(Links, InPlaceOfALaterPartIsRefused) {
    becomesLink(part(2));
    EXPECT_EQ(refusal(), part(2).string() + kLink + "; name the journal itself");
    EXPECT_EQ(master::allBytes(journal()), static_cast<std::int64_t>(fs::file_size(part(1))));
}

TEST_F(Links, ThatAreSwappedInWhileAJournalIsReadChangeNothingThatIsOpen) {
    journal::JournalReader reader = master::openJournal(journal());
    ASSERT_TRUE(reader.next().has_value());
    fs::rename(journal(), aside_ / "journal");
    fs::create_symlink("/etc/passwd", journal());
    becomesLink(part(3));
    std::size_t records = 1;
    const std::string why = test::refusalOf([&] {
        while (reader.next()) {
            ++records;
        }
    });
    EXPECT_EQ(why, part(3).string() + kLink + "; name the journal itself");
    EXPECT_GT(records, 10U) << "parts 1 and 2 were read";
}

TEST_F(Links, PipesSocketsDevicesAndFoldersAreNoJournal) {
    fs::remove(journal());
    const std::string line = journal().string() + ": is not a regular file; name the journal itself";
    support::makePipe(journal());
    EXPECT_TRUE(support::endsByItself([&] { EXPECT_EQ(refusal(), line); }));
    fs::remove(journal());
    fs::create_directory(journal());
    EXPECT_EQ(refusal(), line);
    fs::remove(journal());
    const int listener = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
    const std::string path = journal().string();
    ASSERT_LT(path.size(), sizeof address.sun_path);
    path.copy(address.sun_path, path.size());
    ASSERT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(refusal(), journal().string() + ": cannot be read (No such device or address); check the path");
    close(listener);
    EXPECT_EQ(test::refusalOf([] { (void)master::readJournal("/dev/zero"); }),
              "/dev/zero: is not a regular file; name the journal itself");
}

TEST_F(Links, InPlaceOfCheckpointsOrTheirFolderAreLeftOut) {
    const std::uint64_t newest = master::checkpointsOf(journal()).at(0);
    const fs::path file = master::checkpointFile(journal(), newest);
    ASSERT_EQ(test::refusalOf<base::FormatError>([&] { (void)master::readCheckpoint(file); }), "nothing");
    becomesLink(file.parent_path());
    EXPECT_EQ(test::refusalOf<base::FormatError>([&] { (void)master::readCheckpoint(file); }),
              "is a link, which is not followed");
    EXPECT_EQ(master::restoreSand(journal(), replica_.stepNumber()).checkpointStep, 0U);
    expectWhole(replica_.stepNumber());
}

TEST_F(Links, InPlaceOfTheFolderOfSavedSandAreNotFollowed) {
    const fs::path file = master::saveFile(folder_, "dug");
    const auto place = master::SandPlace::of(scene_);
    master::writeSavedSand(file, {place, 1, 2, replica_.copySand()->encode()});
    const auto load = [&] { (void)master::readSavedSand(file, place, replica_.sandReader()); };
    ASSERT_EQ(test::refusalOf(load), "nothing");
    becomesLink(file.parent_path());
    EXPECT_EQ(test::refusalOf(load), file.string() + kLink + "; nothing was loaded");
}

}  // namespace
