// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/sand_thread.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "host/clock.hpp"

namespace haptic_bridge {
namespace {

constexpr std::int64_t kIdlePoll = 20'000'000;  // [ns], interval at which an idle sand thread empties the hand's queue

std::unique_ptr<DeviceHand> handFor(Pace pace, HapticTick& hand, HandChannel& channel, int stepsPerSecond) {
    if (pace == Pace::fast) {
        return std::make_unique<VirtualHand>(hand, channel, stepsPerSecond);
    }
    return std::make_unique<ChannelHand>(hand, channel, stepsPerSecond);
}

}  // namespace

SandThread::SandThread(sand::Replica replica, Pace pace, HapticTick& hand, HandChannel& channel, Output output)
    : pace_(pace),
      hand_(handFor(pace, hand, channel, replica.rules().stepsPerSecond)),
      maker_(std::move(replica), *hand_, std::move(output)) {
    thread_ = std::thread([this, &channel] { channel.failure.run("the sand thread", [this] { run(); }); });
}

SandThread::~SandThread() {
    {
        const std::lock_guard lock(mutex_);
        commands_.stops = true;
    }
    wake_.notify_one();
    thread_.join();
}

void SandThread::release() {
    {
        const std::lock_guard lock(mutex_);
        commands_.release();
    }
    wake_.notify_one();
}

void SandThread::run() {
    for (bool stopping = false; !stopping;) {
        const bool stepDue = waitForWork();
        Commands commands;
        {
            const std::lock_guard lock(mutex_);
            commands = std::exchange(commands_, {});
        }
        stopping = commands.stops;
        const bool commanded = !commands.empty();
        obey(commands);
        maker_.collect();
        if (stepDue && !commanded && maker_.running()) {
            maker_.makeStep();
        }
        maker_.refresh();
    }
}

void SandThread::obey(Commands& commands) {
    if (commands.released) {
        maker_.release();
    }
    if (commands.grant) {
        maker_.start(commands.grant->session, commands.grant->start);
    }
    for (const CatchUp& steps : commands.catchUps) {
        maker_.catchUp(steps);
    }
    if (commands.state) {
        maker_.state(commands.state->bytes);
    }
    for (const Commands::Frame& frame : commands.frames) {
        maker_.shown(frame.shown, frame.nowNs);
    }
    if (commands.edit) {
        maker_.edit(std::move(*commands.edit));
    }
    if (commands.audits) {
        maker_.audit();
    }
}

/// Sleeps until a command comes or a step is due. Returns whether a step is due.
bool SandThread::waitForWork() {
    std::unique_lock lock(mutex_);
    const auto commanded = [this] { return !commands_.empty(); };
    const bool running = maker_.running();
    if (pace_ == Pace::fast) {
        if (!running || maker_.blocked()) {
            wake_.wait(lock, commanded);
            return false;
        }
        return true;
    }
    const std::int64_t until = running ? std::min(maker_.due(), hand_->refreshDue()) : host::monotonicNs() + kIdlePoll;
    const std::chrono::steady_clock::time_point when{std::chrono::nanoseconds(until)};
    return !wake_.wait_until(lock, when, commanded) && running && host::monotonicNs() >= maker_.due();
}

}  // namespace haptic_bridge
