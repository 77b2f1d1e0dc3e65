// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "haptic_bridge/hand/pace.hpp"
#include "haptic_bridge/loop/hand_channel.hpp"
#include "haptic_bridge/server/commands.hpp"
#include "haptic_bridge/server/step_maker.hpp"

namespace haptic_bridge {

/// The sand thread. Its StepMaker makes steps when they are due, and it carries out commands between them. It sleeps
/// until a command comes or a step is due.
///
/// In real time the StepClock decides when a step is due. The step takes the samples that the force thread has queued.
/// If the hand is far ahead of the wall, the step takes only a part of them (PathBuilder). Under the fast pace there is
/// no clock: steps come as fast as the wall's window allows, with the samples of a VirtualHand.
class SandThread {
public:
    using Output = StepMaker::Output;  // callbacks, called on the sand thread

    /// Under Pace::fast this thread runs the ticks of `hand`, and no other thread may use it. The channel gets an
    /// exception of this thread.
    /// `replica` is the scene's sand.
    SandThread(sand::Replica replica, Pace pace, HapticTick& hand, HandChannel& channel, Output output);
    ~SandThread();
    SandThread(const SandThread&) = delete;
    SandThread& operator=(const SandThread&) = delete;

    // Any thread may call these. The answers come through Output. Commands limits how much waits meanwhile.
    void start(std::uint32_t session, const StartMessage& start) { post(Commands::Grant{session, start}); }
    void state(base::Bytes bytes) { post(State{std::move(bytes)}); }
    void catchUp(CatchUp steps) { post(std::move(steps)); }
    void shown(const Shown& frame, std::int64_t nowNs) { post(Commands::Frame{frame, nowNs}); }
    void edit(EditRequest request) { post(std::move(request)); }
    void audit() { post(Commands::Audit{}); }
    void release();

    [[nodiscard]] WithheldCounts withheld() const { return maker_.withheld(); }
    [[nodiscard]] std::uint64_t dropped() const { return maker_.dropped(); }

private:
    template <class Command>
    void post(Command command) {
        {
            const std::lock_guard lock(mutex_);
            commands_.add(std::move(command));
        }
        wake_.notify_one();
    }
    void run();
    bool waitForWork();
    void obey(Commands& commands);

    const Pace pace_;
    const std::unique_ptr<DeviceHand> hand_;

    std::mutex mutex_;
    std::condition_variable wake_;
    Commands commands_;

    // For the sand thread only.
    StepMaker maker_;
    std::thread thread_;
};

}  // namespace haptic_bridge
