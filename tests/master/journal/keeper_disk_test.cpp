// SPDX-License-Identifier: Apache-2.0
// A disk that is full, read-only or refuses a write.
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "base/input_error.hpp"
#include "master/journal/checkpoint.hpp"
#include "tests/master/journal/keeper_fixture.hpp"
#include "tests/support/journal/read_session.hpp"
#include "tests/support/machine/small_disk.hpp"

namespace {

class KeeperDisk : public test::KeeperTest {};

/// Scope in which no file of this process may be longer than a limit.
class FileLimit {
public:
    explicit FileLimit(std::uintmax_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &before_);
        rlimit small = before_;
        small.rlim_cur = bytes;
        setrlimit(RLIMIT_FSIZE, &small);
    }
    ~FileLimit() {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    FileLimit(const FileLimit&) = delete;
    FileLimit& operator=(const FileLimit&) = delete;

private:
    rlimit before_{};
    void (*handler_)(int);
};

TEST_F(KeeperDisk, ARequiredJournalThatCannotBeWrittenEndsTheSession) {
    begin({});
    ASSERT_TRUE(showFrame());
    const FileLimit limit(std::filesystem::file_size(journal()) + 9);
    EXPECT_THROW(showFrame(), master::DiskFailure);
    EXPECT_EQ(replica_.stepNumber(), 1U) << "a step that is not on disk is not applied";
    expectWhole(1);
}

TEST_F(KeeperDisk, WithBestEffortTheSessionGoesOnWithoutAJournal) {
    begin({.policy = master::JournalPolicy::bestEffort});
    ASSERT_TRUE(showFrame());
    {
        const FileLimit limit(std::filesystem::file_size(journal()) + 9);
        EXPECT_TRUE(showFrame());
    }
    EXPECT_TRUE(showFrame());
    EXPECT_EQ(replica_.stepNumber(), 3U);
    EXPECT_EQ(keeper_->state(), "failed");
    EXPECT_EQ(master::readJournal(journal()).frames.size(), 1U);
}

TEST_F(KeeperDisk, AFullDiskStopsTheSandUntilThereIsRoom) {
    support::testOnSmallDisk(folder_, "size=4m", [this] {
        begin({.checkpointSeconds = 0});
        ASSERT_TRUE(showFrame());
        // The session first uses the reserved room, and no accepted step is refused.
        support::fill(folder_ / "filler");
        const sand::Edit large = sand::Edit::loaded(base::Bytes(60'000, 7));  // not sand, so the load is ignored
        int frames = 1;
        while (showFrame(large)) {
            ASSERT_LT(++frames, 1000);
        }
        EXPECT_GT(frames, 2);
        EXPECT_EQ(keeper_->state(), "no_room");
        EXPECT_FALSE(showFrame()) << "the sand is stopped";
        expectWhole(replica_.stepNumber());
        keeper_->force({0.25});  // is written when there is room, and switching forces off does not wait for it
        const std::uint64_t stood = replica_.stepNumber();
        std::filesystem::remove(folder_ / "filler");
        while (!showFrame()) {  // the keeper tries the disk about once per second
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        EXPECT_EQ(keeper_->state(), "written");
        EXPECT_EQ(keeper_->stops(), 1U);
        EXPECT_EQ(replica_.stepNumber(), stood + 1);
        expectWhole(replica_.stepNumber());
        keeper_.reset();
        EXPECT_EQ(test::readSession(journal())->forceShare, 0.25);
    });
}

// Room for a few steps must not start the sand again, because it would soon stop again.
TEST_F(KeeperDisk, ALittleRoomDoesNotEndTheStop) {
    support::testOnSmallDisk(folder_, "size=4m", [this] {
        begin({.checkpointSeconds = 0});
        support::fill(folder_ / "filler");
        const sand::Edit large = sand::Edit::loaded(base::Bytes(60'000, 7));  // not sand, so the load is ignored
        int frames = 1;
        while (showFrame(large)) {
            ASSERT_LT(++frames, 1000);
        }
        const auto place = [this] { return journal::JournalEnd{replica_.stepNumber(), replica_.stateHash()}; };
        EXPECT_FALSE(keeper_->hasRoomFor(0, place())) << "a command right after the stop";
        const auto filled = std::filesystem::file_size(folder_ / "filler");
        std::filesystem::resize_file(folder_ / "filler", filled - (256 << 10));  // more than the steps of a frame need
        for (int turn = 0; turn < 3; ++turn) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // the keeper tries the disk once per second
            EXPECT_FALSE(keeper_->mayTake(1 << 16, place()));
            EXPECT_FALSE(keeper_->hasRoomFor(1 << 10, place()));
        }
        std::filesystem::resize_file(folder_ / "filler", filled - (2 << 20));
        while (!showFrame()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        EXPECT_EQ(keeper_->stops(), 1U);
        EXPECT_TRUE(keeper_->hasRoomFor(1 << 10, place()));
        keeper_.reset();
    });
}

TEST_F(KeeperDisk, SandThatDoesNotFitStopsNothing) {
    support::testOnSmallDisk(folder_, "size=4m", [this] {
        begin({.checkpointSeconds = 0});
        EXPECT_FALSE(keeper_->hasRoomFor(8 << 20, {0, replica_.stateHash()}));
        EXPECT_EQ(keeper_->state(), "written");
        EXPECT_TRUE(showFrame());
        EXPECT_EQ(keeper_->stops(), 0U);
        keeper_.reset();
    });
}

TEST_F(KeeperDisk, AFullDiskAtTheHeaderIsNamedAndTheEarlierJournalIsKept) {
    support::testOnSmallDisk(folder_, "size=4m", [this] {
        begin({.checkpointSeconds = 0});
        ASSERT_TRUE(showFrame());
        keeper_.reset();
        support::fill(folder_ / "filler");
        try {
            begin({});
            ADD_FAILURE() << "not refused";
        } catch (const base::InputError& error) {
            EXPECT_EQ(error.what(), journal().string() + ": the journal cannot be written (No space left on device)");
        }
        EXPECT_FALSE(std::filesystem::exists(journal()));
        EXPECT_FALSE(std::filesystem::exists(journal().string() + ".part"));
        const journal::Journal earlier = master::readJournal(journal().string() + ".previous");
        EXPECT_EQ(earlier.frames.size(), 1U);
        EXPECT_EQ(earlier.tornBytes, 0);
        std::filesystem::remove(folder_ / "filler");
        begin({});  // the next try finds room
        EXPECT_EQ(master::readJournal(journal().string() + ".previous").frames.size(), 1U);
        keeper_.reset();
    });
}

TEST_F(KeeperDisk, AFullDiskAtACheckpointStopsNothingAndLeavesNoHalf) {
    support::testOnSmallDisk(folder_, "size=4m", [this] {
        begin({.checkpointSeconds = 1e-9});
        ASSERT_TRUE(showFrame());
        while (master::checkpointsOf(journal()).empty()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        support::fill(folder_ / "filler");  // the journal has reserved room for its steps
        const std::vector<std::uint64_t> before = master::checkpointsOf(journal());
        for (int frame = 0; keeper_->checkpointsFailed() == 0; ++frame) {
            ASSERT_LT(frame, 1000);
            ASSERT_TRUE(showFrame());
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        keeper_->finish({replica_.stepNumber(), replica_.stateHash()});
        EXPECT_TRUE(keeper_->whole());
        keeper_.reset();
        EXPECT_EQ(master::checkpointsOf(journal()), before) << "the older one stays";
        const auto checkpoints = master::checkpointFile(journal(), 0).parent_path();
        for (const auto& entry : std::filesystem::directory_iterator(checkpoints)) {
            EXPECT_EQ(entry.path().extension(), ".checkpoint") << entry.path();
        }
        expectWhole(replica_.stepNumber());
    });
}

TEST_F(KeeperDisk, AReadOnlyFolderIsNamed) {
    support::testOnSmallDisk(
        folder_, "size=4m",
        [this] {
            try {
                begin({});
                ADD_FAILURE() << "not refused";
            } catch (const base::InputError& error) {
                EXPECT_NE(
                    std::string(error.what()).find("cannot be made (Read-only file system); choose another --out"),
                    std::string::npos)
                    << error.what();
            }
        },
        MS_RDONLY);
}

}  // namespace
