// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <variant>

#include "haptic_bridge/loop/hand_channel.hpp"
#include "haptic_bridge/server/step_maker.hpp"

namespace haptic_bridge {

enum class Pace : std::uint8_t { realtime, fast };

/// The sand thread. Its StepMaker makes steps when they are due, and it carries out commands between them. It sleeps
/// until a command comes or a step is due.
///
/// In real time the StepClock decides when a step is due. The step takes the samples that the force thread has queued.
/// If the hand is far ahead of the wall, the step takes only a part of them (PathBuilder). Under the fast pace there is
/// no clock: steps come as fast as the wall's window allows, with the samples of a VirtualFeed.
class SandThread {
public:
    using Output = StepMaker::Output;  // callbacks, called on the sand thread

    /// Under Pace::fast this thread runs the ticks of `hand`, and no other thread may use it.
    /// `watcher` may be null. It is shown the sand after every step, on the sand thread.
    SandThread(const scene::Scene& scene, Pace pace, HapticTick& hand, HandChannel& channel, Output output,
               const sand::grid::Erosion::Options& sweeps = {}, SandWatcher* watcher = nullptr);
    ~SandThread();
    SandThread(const SandThread&) = delete;
    SandThread& operator=(const SandThread&) = delete;

    // Any thread may call these. The answers come through Output.
    void start(std::uint32_t session, const Start& start) { post(Granted{session, start}); }
    void state(base::Bytes bytes) { post(State{std::move(bytes)}); }
    void catchUp(CatchUp steps) { post(std::move(steps)); }
    void shown(const Shown& frame, std::int64_t nowNs) { post(Frame{frame, nowNs}); }
    void edit(EditRequest request) { post(std::move(request)); }
    void release() { post(Released{}); }

    [[nodiscard]] std::uint64_t withheld() const { return maker_.withheld(); }
    [[nodiscard]] std::uint64_t dropped() const { return maker_.dropped(); }

private:
    struct Granted {
        std::uint32_t session;
        Start start;
    };
    struct Frame {
        Shown shown;
        std::int64_t nowNs;
    };
    struct Released {};
    struct Stop {};
    using Command = std::variant<Granted, State, CatchUp, Frame, EditRequest, Released, Stop>;

    void post(Command command);
    void run();
    bool waitForWork();
    void obey(Granted& command) { maker_.start(command.session, command.start); }
    void obey(State& command) { maker_.state(command.bytes); }
    void obey(CatchUp& command) { maker_.catchUp(command); }
    void obey(Frame& command) { maker_.shown(command.shown, command.nowNs); }
    void obey(EditRequest& request) { maker_.edit(std::move(request)); }
    void obey(Released&) { maker_.release(); }
    void obey(Stop&) { stopping_ = true; }
    void showSand();

    const Pace pace_;
    const std::unique_ptr<HandFeed> feed_;

    std::mutex mutex_;
    std::condition_variable wake_;
    std::deque<Command> commands_;

    // For the sand thread only.
    StepMaker maker_;
    SandWatcher* watcher_;
    bool stopping_ = false;
    std::thread thread_;
};

}  // namespace haptic_bridge
