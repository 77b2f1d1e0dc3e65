// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/end_signals.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>

namespace {

using haptic_bridge::EndSignals;
using namespace std::chrono_literals;

class EndSignalsTest : public testing::Test {
protected:
    /// Raises a signal, and runs its handler.
    void signalComes() {
        const int before = read_ + held_ + served_;
        ASSERT_EQ(raise(SIGTERM), 0);
        for (int i = 0; i < 100 && read_ + held_ + served_ == before; ++i) {
            io_.run_one_for(100ms);
        }
    }

    boost::asio::io_context io_;
    EndSignals signals_{io_};
    int read_ = 0, held_ = 0, served_ = 0;
};

TEST_F(EndSignalsTest, CallTheFunctionOfTheMomentOnce) {
    signals_.onFirst([this] { ++read_; });
    signals_.hold([this] { ++held_; });
    signals_.onFirst([this] { ++served_; });
    EXPECT_EQ(served_, 0);
    signalComes();
    ASSERT_EQ(raise(SIGTERM), 0);
    io_.run_for(200ms);
    EXPECT_EQ(read_, 0);
    EXPECT_EQ(held_, 0);
    EXPECT_EQ(served_, 1) << "a second signal changes nothing";
}

TEST_F(EndSignalsTest, NoteASignalWhileTheyAreHeld) {
    signals_.onFirst([this] { ++read_; });
    signals_.hold([this] { ++held_; });
    signalComes();
    EXPECT_EQ(held_, 1);
    EXPECT_EQ(read_, 0) << "a device may be open";
    signals_.onFirst([this] { ++served_; });
    EXPECT_EQ(served_, 1);
}

TEST_F(EndSignalsTest, EndBeforeTheyAreHeld) {
    signals_.onFirst([this] { ++read_; });
    signalComes();
    EXPECT_EQ(read_, 1);
}

// A driver may never open its device.
TEST(EndSignalsDeathTest, ASecondSignalEndsTheProcessWhileTheyAreHeld) {
    EXPECT_EXIT(
        {
            boost::asio::io_context io;
            EndSignals signals(io);
            signals.hold([] {});
            for (int i = 0; i < 2; ++i) {
                raise(SIGTERM);
                io.run_for(500ms);
            }
        },
        testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
