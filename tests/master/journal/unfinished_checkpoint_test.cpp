// SPDX-License-Identifier: Apache-2.0
#include "master/journal/unfinished_checkpoint.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

namespace {

using master::UnfinishedCheckpoint;
using namespace std::chrono_literals;

constexpr std::int64_t kSecond = 1'000'000'000;

/// A clock on which ten seconds pass between two looks.
struct Clock {
    std::int64_t operator()() const { return (*seconds += 10) * kSecond; }
    std::shared_ptr<std::int64_t> seconds = std::make_shared<std::int64_t>(0);
};

bool never() { return false; }

/// Writes until it is to be left out.
void writeForEver(UnfinishedCheckpoint::Work& work) {
    for (double done = 0;; done += 1e-3) {
        work.requireWanted();
        work.setDone(done);
        std::this_thread::sleep_for(1ms);
    }
}

TEST(UnfinishedCheckpoint, IsFinishedHoweverLongItTakesIfThereIsNoOlderOne) {
    std::promise<void> gate;
    std::atomic<bool> written = false;
    UnfinishedCheckpoint checkpoint(7, [&](UnfinishedCheckpoint::Work& work) {
        gate.get_future().wait();
        work.requireWanted();
        written = true;
    });
    EXPECT_FALSE(checkpoint.endsWithin(0s));
    const Clock clock;
    bool opened = false;
    const auto openLater = [&] {
        if (!opened && *clock.seconds > 60) {
            opened = true;
            gate.set_value();
        }
        return false;
    };
    EXPECT_TRUE(checkpoint.finish(false, openLater, clock));
    EXPECT_TRUE(written);
}

TEST(UnfinishedCheckpoint, IsLeftOutAfterSomeSecondsIfThereIsAnOlderOne) {
    UnfinishedCheckpoint checkpoint(7, writeForEver);
    testing::internal::CaptureStderr();
    EXPECT_TRUE(checkpoint.finish(true, never, Clock()));
    EXPECT_NE(testing::internal::GetCapturedStderr().find(
                  "the checkpoint of step 7 is left out, because it was not written within 5 s\n"),
              std::string::npos);
}

TEST(UnfinishedCheckpoint, IsAbandonedWithoutAWaitForItsThread) {
    std::promise<void> gate;
    UnfinishedCheckpoint checkpoint(7, [&gate](UnfinishedCheckpoint::Work&) { gate.get_future().wait(); });
    EXPECT_FALSE(checkpoint.finish(
        false, [] { return true; }, Clock()))
        << "the thread still waits";
    gate.set_value();
}

/// Gets a signal of the end while a checkpoint is written, as a master does at the second Ctrl-C.
[[noreturn]] void finishAfter(int signal) {
    std::promise<void> never;
    UnfinishedCheckpoint checkpoint(7, [&never](UnfinishedCheckpoint::Work&) { never.get_future().wait(); });
    std::thread([signal] {
        std::this_thread::sleep_for(300ms);
        kill(getpid(), signal);
    }).detach();
    std::_Exit(master::finishUnlessSignalled(checkpoint, false) ? 1 : 7);
}

TEST(UnfinishedCheckpoint, IsAbandonedAfterASignal) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto abandoned = "the checkpoint of step 7 is abandoned; the journal has every step";
    EXPECT_EXIT(finishAfter(SIGTERM), testing::ExitedWithCode(7), abandoned);
    EXPECT_EXIT(finishAfter(SIGINT), testing::ExitedWithCode(7), abandoned);
}

TEST(UnfinishedCheckpoint, ThatGetsNoFurtherEnds) {
    std::promise<void> gate;
    UnfinishedCheckpoint checkpoint(7, [&gate](UnfinishedCheckpoint::Work&) { gate.get_future().wait(); });
    const Clock clock;
    EXPECT_FALSE(checkpoint.finish(false, never, clock));
    EXPECT_GE(*clock.seconds, UnfinishedCheckpoint::kStalledSeconds);
    gate.set_value();
}

TEST(UnfinishedCheckpoint, ThatFailsSaysWhy) {
    UnfinishedCheckpoint checkpoint(7,
                                    [](UnfinishedCheckpoint::Work&) { throw std::runtime_error("the disk is full"); });
    testing::internal::CaptureStderr();
    EXPECT_TRUE(checkpoint.finish(false, never));
    EXPECT_NE(testing::internal::GetCapturedStderr().find(
                  "the disk is full; no checkpoint was written, and the journal has every step\n"),
              std::string::npos);
}

}  // namespace
