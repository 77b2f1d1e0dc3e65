// SPDX-License-Identifier: Apache-2.0
#include "master/journal/keeper.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include "base/input_error.hpp"
#include "host/version.hpp"
#include "master/journal/checkpoint.hpp"
#include "master/journal/file_parts.hpp"
#include "master/journal/journal.hpp"
#include "tests/master/journal/keeper_fixture.hpp"
#include "tests/support/journal/read_session.hpp"
#include "tests/support/processes/blocked_child.hpp"
#include "tests/support/seed.hpp"

namespace {

class Keeper : public test::KeeperTest {};

TEST_F(Keeper, SwitchedOffItWritesNothing) {
    begin({.policy = master::JournalPolicy::off, .checkpointSeconds = 1e-9});
    ASSERT_TRUE(showFrame());
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
    EXPECT_EQ(keeper_->state(), "off");
}

TEST_F(Keeper, SwitchedOffItLeavesNoJournalOfAnotherSessionInItsPlace) {
    begin({});
    ASSERT_TRUE(showFrame());
    begin({.policy = master::JournalPolicy::off});
    EXPECT_FALSE(std::filesystem::exists(journal()));
    EXPECT_EQ(master::readJournal(folder_ / "session.journal.previous").frames.size(), 1U);
}

TEST_F(Keeper, ANewSessionRemovesNoPipeInPlaceOfItsCheckpoints) {
    support::makePipe(folder_ / "checkpoints");
    begin({});
    EXPECT_TRUE(std::filesystem::is_fifo(folder_ / "checkpoints"));
}

// A new session renames no file before the session that still runs in the folder has ended.
TEST_F(Keeper, ANewSessionWaitsForTheOneThatStillWritesItsJournal) {
    begin({});
    ASSERT_TRUE(showFrame());
    std::optional<master::JournalKeeper> second;
    std::atomic<bool> moved = true;
    std::thread first([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the second session has begun by now
        moved = std::filesystem::exists(folder_ / "session.journal.previous");
        keeper_->finish({replica_.stepNumber(), replica_.stateHash()});
        keeper_.reset();
    });
    second.emplace(folder_, master::JournalOptions{}, scene_, nullptr, "", "test");
    first.join();
    EXPECT_FALSE(moved);
    const journal::Journal previous = master::readJournal(folder_ / "session.journal.previous");
    EXPECT_TRUE(previous.end.has_value()) << "the first session has an orderly end";
    EXPECT_EQ(previous.frames.size(), 1U);
}

TEST_F(Keeper, AFolderThatCannotBeWrittenToIsNamed) {
    std::ofstream(folder_ / "file") << "in the way";
    try {
        const master::JournalKeeper keeper(folder_ / "file", {}, scene_, nullptr, "", "test");
        ADD_FAILURE() << "not refused";
    } catch (const base::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("cannot be made (Not a directory); choose another --out"),
                  std::string::npos)
            << error.what();
    }
}

TEST_F(Keeper, KeepsTheNewestCheckpointsAndResumesFromThem) {
    begin({.checkpointSeconds = 1e-9});
    for (int frame = 0; frame < 30; ++frame) {
        ASSERT_TRUE(showFrame());
        keeper_->shown(replica_, frame_, 1, replica_.stateHash());
    }
    keeper_->finish({replica_.stepNumber(), replica_.stateHash()});
    if (std::optional<master::UnfinishedCheckpoint> last = keeper_->takeUnfinished()) {  // on a busy machine
        EXPECT_TRUE(last->finish(false, [] { return false; }));
    }
    const auto steps = master::checkpointsOf(journal());
    ASSERT_FALSE(steps.empty());
    EXPECT_LE(steps.size(), 3U);
    EXPECT_GE(keeper_->copyMs().size(), steps.size());
    EXPECT_EQ(keeper_->checkpointsFailed(), 0U);
    EXPECT_EQ(master::restoreSand(journal(), 30).checkpointStep, steps.front());
    expectWhole(30);
}

TEST_F(Keeper, IsWholeOnlyWithAnEndAndEveryStep) {
    const auto end = [this] { keeper_->finish({replica_.stepNumber(), replica_.stateHash()}); };
    begin({});
    ASSERT_TRUE(showFrame());
    EXPECT_FALSE(keeper_->whole()) << "it has no end";
    keeper_->doubt({});
    end();
    EXPECT_FALSE(keeper_->whole()) << "a majority was not compared with it";
    keeper_->checked({});
    end();
    EXPECT_TRUE(keeper_->whole());
    keeper_.reset();
    std::filesystem::create_directories(master::checkpointFile(journal(), 7).parent_path());
    // A checkpoint after the end of the journal: the journal has lost its step.
    std::ofstream(master::checkpointFile(journal(), 7)) << "later";
    for (const char* resume : {"the first", "the second"}) {
        const master::ResumedSession resumed = test::readSession(journal()).value();
        keeper_.emplace(folder_, master::JournalOptions{}, scene_, &resumed, "a test", "test");
        end();
        EXPECT_FALSE(keeper_->whole()) << resume;
        keeper_.reset();
    }
}

TEST_F(Keeper, TheShareOfTheForceIsOnDiskBeforeAnyFurtherStep) {
    begin({});
    ASSERT_TRUE(showFrame());
    keeper_->force({0});
    EXPECT_EQ(test::readSession(journal())->forceShare, 0) << "as a kill at this moment would leave it";
}

// A wall that rests has no further step for hours.
TEST_F(Keeper, ADecisionOfAMajorityIsOnDiskBeforeAnyFurtherStep) {
    begin({});
    ASSERT_TRUE(showFrame());
    const auto recordsOnDisk = [this] {
        journal::JournalReader reader = master::openJournal(journal());
        int records = 0;
        while (reader.next()) {
            ++records;
        }
        return records;
    };
    ASSERT_EQ(recordsOnDisk(), 1);
    keeper_->doubt({frame_, {1, replica_.stateHash()}});
    EXPECT_EQ(recordsOnDisk(), 2);
    keeper_->checked({frame_, {1, replica_.stateHash()}, false});
    EXPECT_EQ(recordsOnDisk(), 3);
}

TEST_F(Keeper, NoPipeInTheFolderStopsASessionOrItsResume) {
    begin({.checkpointSeconds = 1e-9});
    while (master::checkpointsOf(journal()).empty()) {
        ASSERT_TRUE(showFrame());
    }
    keeper_->finish({replica_.stepNumber(), replica_.stateHash()});
    keeper_.reset();
    const std::uint64_t newest = master::checkpointsOf(journal()).front();
    std::filesystem::remove(master::checkpointFile(journal(), newest));
    support::makePipe(master::checkpointFile(journal(), newest));
    EXPECT_TRUE(support::endsByItself([this] { expectWhole(replica_.stepNumber()); })) << "a checkpoint";
    EXPECT_TRUE(support::endsByItself([this, newest] {
        master::Checkpoint again;
        again.step = newest;
        EXPECT_THROW(master::writeCheckpoint(journal(), again, 3), base::InputError);
    }));
    support::makePipe(journal().string() + ".part");
    EXPECT_TRUE(support::endsByItself([this] { begin({}); })) << "an unfinished journal";
    std::filesystem::remove(journal());
    support::makePipe(journal());
    EXPECT_TRUE(support::endsByItself([this] { EXPECT_THROW(begin({}), base::InputError); })) << "a journal";
    EXPECT_TRUE(support::endsByItself([this] { EXPECT_THROW((void)test::readSession(journal()), base::InputError); }));
}

// The journal has lost the step of the newest checkpoint, as after a crash.
TEST_F(Keeper, RemovesCheckpointsOfStepsThatItsJournalDoesNotHold) {
    begin({.checkpointSeconds = 1e-9});
    while (master::checkpointsOf(journal()).empty()) {
        ASSERT_TRUE(showFrame());
        std::this_thread::yield();
    }
    keeper_.reset();
    const auto newest = master::checkpointsOf(journal()).front();
    std::optional<test::ReadSession> resumed = test::readSession(journal());
    ASSERT_TRUE(resumed.has_value());
    resumed->step = newest - 1;
    begin({.checkpointSeconds = 0}, &*resumed);
    for (const std::uint64_t step : master::checkpointsOf(journal())) {
        EXPECT_LT(step, newest);
    }
}

TEST_F(Keeper, GoesOnInAnotherPartAndIsReadAsOne) {
    begin({.checkpointSeconds = 0, .partBytes = 2000});
    for (int frame = 0; frame < 100; ++frame) {
        ASSERT_TRUE(showFrame());
    }
    keeper_->finish({replica_.stepNumber(), replica_.stateHash()});
    const std::uint32_t parts = keeper_->parts();
    ASSERT_GT(parts, 2U);
    EXPECT_TRUE(std::filesystem::exists(master::partOf(journal(), parts)));
    EXPECT_FALSE(std::filesystem::exists(master::partOf(journal(), parts + 1)));
    expectWhole(100);
    // A resumed session continues the last part.
    keeper_.reset();
    const auto resumed = test::readSession(journal());
    ASSERT_TRUE(resumed.has_value());
    EXPECT_EQ(resumed->place.part, parts);
    begin({.checkpointSeconds = 0, .partBytes = 2000}, &*resumed);
    for (int frame = 0; frame < 100; ++frame) {
        ASSERT_TRUE(showFrame());
    }
    EXPECT_GT(keeper_->parts(), parts + 1);
    expectWhole(200);
    // A new session renames all parts.
    keeper_.reset();
    replica_ = sand::Replica(scene_);
    begin({});
    EXPECT_FALSE(std::filesystem::exists(master::partOf(journal(), 2)));
    EXPECT_EQ(master::readJournal(journal().string() + ".previous").frames.size(), 200U);
}

TEST_F(Keeper, APartThatIsMissingOrOfAnotherSessionIsNamed) {
    begin({.checkpointSeconds = 0, .partBytes = 2000});
    for (int frame = 0; frame < 100; ++frame) {
        ASSERT_TRUE(showFrame());
    }
    keeper_.reset();
    const auto complaint = [this] {
        try {
            (void)master::readJournal(journal());
        } catch (const base::InputError& error) {
            return std::string(error.what());
        }
        return std::string("none");
    };
    const std::filesystem::path second = master::partOf(journal(), 2), away = folder_ / "away";
    std::filesystem::rename(second, away);
    EXPECT_NE(complaint().find("session.journal: continues in session.journal.2, which is missing"), std::string::npos)
        << complaint();
    std::filesystem::copy(master::partOf(journal(), 3), second);
    EXPECT_NE(complaint().find("session.journal.2: does not continue session.journal"), std::string::npos)
        << complaint();
    std::filesystem::remove(second);
    std::filesystem::copy(away, second);
    EXPECT_EQ(complaint(), "none");
    // A part without its last record does not name the next part, but the next part exists.
    std::filesystem::resize_file(second, std::filesystem::file_size(second) - 40);
    EXPECT_NE(complaint().find("session.journal.3 continues the session after missing records"), std::string::npos)
        << complaint();
    try {
        (void)master::readJournal(master::partOf(journal(), 3));
        ADD_FAILURE() << "a single part was read";
    } catch (const base::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("is part 3 of a session; name its first part"), std::string::npos);
    }
}

// A session was killed after it made a part and before it named it. The part has no records, and is made again.
TEST_F(Keeper, APartThatWasOnlyMadeIsNoHarm) {
    begin({.checkpointSeconds = 0, .partBytes = 2000});
    while (keeper_->parts() < 2) {
        ASSERT_TRUE(showFrame());
    }
    keeper_.reset();
    const std::uint64_t steps = replica_.stepNumber() - 1;  // the last step is in the second part
    // Cuts off the record that names the second part.
    std::filesystem::resize_file(journal(), std::filesystem::file_size(journal()) - 25);
    EXPECT_THROW((void)master::readJournal(journal()), base::InputError) << "the second part holds a step";
    // Cuts the second part to its header.
    std::uint64_t chain = 0;
    std::ifstream stream(master::partOf(journal(), 2), std::ios::binary);
    const base::Bytes bytes{std::istreambuf_iterator<char>(stream), {}};
    base::ByteReader reader(bytes);
    (void)journal::decodeHeader(reader, host::release(), chain);
    ASSERT_GT(reader.rest().size(), 0U) << "the step is cut off";
    std::filesystem::resize_file(master::partOf(journal(), 2), bytes.size() - reader.rest().size());
    EXPECT_EQ(master::readJournal(journal()).frames.size(), steps);
    const auto resumed = test::readSession(journal());
    ASSERT_TRUE(resumed.has_value());
    EXPECT_EQ(resumed->place.part, 1U);
    replica_.decodeState(resumed->sand->encodeState());
    begin({.checkpointSeconds = 0, .partBytes = 2000}, &*resumed);
    ASSERT_TRUE(showFrame());
    expectWhole(steps + 1);
}

TEST_F(Keeper, AnEmptyJournalIsCalledEmpty) {
    std::ofstream(journal()).flush();
    try {
        (void)master::readJournal(journal());
        ADD_FAILURE() << "it was read";
    } catch (const base::InputError& error) {
        EXPECT_EQ(std::string(error.what()), journal().string() + ": is empty");
    }
}

// The parent kills the child at any place. The child sends each step through a pipe when append() has returned. These
// steps must be in the journal.
TEST_F(Keeper, KilledInTheMiddleOfWritesNothingThatWasOnDiskIsLost) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    for (int kill = 0; kill < 20; ++kill) {
        int told[2];
        ASSERT_EQ(pipe(told), 0);
        const pid_t child = fork();
        if (child == 0) {
            close(told[0]);
            begin({.checkpointSeconds = 1e-9, .partBytes = 20'000});
            while (showFrame()) {
                const std::uint64_t steps = replica_.stepNumber();
                if (write(told[1], &steps, sizeof steps) != sizeof steps) {
                    break;
                }
            }
            _exit(1);
        }
        close(told[1]);
        std::uint64_t steps = 0, heard = 0;
        const auto enough = random() % 100 + 1;
        while (heard < enough && read(told[0], &heard, sizeof heard) == sizeof heard) {
        }
        std::this_thread::sleep_for(std::chrono::microseconds(random() % 500));
        ::kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        for (steps = heard; read(told[0], &heard, sizeof heard) == sizeof heard;) {
            steps = heard;
        }
        close(told[0]);
        const auto resumed = test::readSession(journal());
        ASSERT_TRUE(resumed.has_value()) << "seed " << seed << ", kill " << kill;
        ASSERT_GE(resumed->step, steps) << "seed " << seed << ", kill " << kill;
        ASSERT_LE(resumed->step, steps + 1) << "seed " << seed << ", kill " << kill;
        // The sand from the checkpoints must equal the sand from the scene. restoreSand() compares the hashes on the
        // way.
        sand::Replica undisturbed(scene_);
        for (const journal::JournalFrame& frame : master::readJournal(journal()).frames) {
            ASSERT_EQ(frame.hashBefore, undisturbed.stateHash());
            undisturbed.apply(frame.steps.front());
        }
        ASSERT_EQ(resumed->hash, undisturbed.stateHash()) << "seed " << seed << ", kill " << kill;
    }
    std::printf("20 kills, seed %u\n", seed);
}

}  // namespace
