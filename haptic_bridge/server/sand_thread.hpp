// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <variant>

#include "haptic_bridge/link/protocol.hpp"
#include "haptic_bridge/loop/hand_channel.hpp"
#include "haptic_bridge/server/step_clock.hpp"
#include "sand/replica.hpp"
#include "scene/scene.hpp"

namespace haptic_bridge {

enum class Pace : std::uint8_t { realtime, fast };

/// The sand thread: owns the server's replica, and numbers the steps while a master is linked.
///
/// In real time a step is due by the StepClock and takes what the force thread has queued, of a hand that is ahead of
/// its wall a part (PathBuilder). Under the fast pace there is no clock: step n takes exactly the samples at the
/// virtual milliseconds in ((n−1)/rate, n/rate], counted from the first start, as quickly as the wall's window allows.
class SandThread {
public:
    // What a wall that cannot keep up has queued is how late it shows the hand: 32 steps made a second of it.
    static constexpr std::uint64_t kWindow = 8;  // [step] that may be ahead of the wall

    /// Called on the sand thread; `session` is the one given to start().
    struct Output {
        std::function<void(std::uint32_t session)> ready;
        std::function<void(std::uint32_t session, NeedState need)> needState;
        std::function<void(std::uint32_t session, std::string why)> unusable;  // the state sent does not fit
        std::function<void(std::uint32_t session, base::Bytes stepMessage)> step;
    };

    /// Under Pace::fast `hand` is ticked by this thread, and must not be used by another.
    /// `watcher` may be null: told of the sand after every step, on the sand thread.
    SandThread(const scene::Scene& scene, Pace pace, HapticTick& hand, HandChannel& channel, Output output,
               const sand::grid::Erosion::Options& sweeps = {}, SandWatcher* watcher = nullptr);
    ~SandThread();
    SandThread(const SandThread&) = delete;
    SandThread& operator=(const SandThread&) = delete;

    // From any thread; the answer comes through Output.
    void start(std::uint32_t session, const Start& start) { post(Granted{session, start}); }
    void state(base::Bytes bytes) { post(State{std::move(bytes)}); }
    void catchUp(CatchUp steps) { post(std::move(steps)); }
    void shown(const Shown& frame, std::int64_t nowNs) { post(Frame{frame, nowNs}); }
    void edit(EditRequest request) { post(std::move(request)); }
    void release() { post(Released{}); }

    [[nodiscard]] std::uint64_t withheld() const { return withheld_; }  // steps, over the program's life
    [[nodiscard]] std::uint64_t dropped() const { return dropped_ + channel_.overflow; }

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
    void obey(Granted& command);
    void obey(State& command);
    void obey(CatchUp& command);
    void obey(Frame& command);
    void obey(EditRequest& request) { edit_ = std::move(request.edit); }
    void obey(Released&);
    void obey(Stop&) { stopping_ = true; }
    void begin();
    [[nodiscard]] bool blocked() const { return terrain_.stepNumber() >= shown_ + kWindow; }
    void collect();
    void gatherVirtual();
    void makeStep();
    void publishSurface();
    void showSand();

    const scene::Scene& scene_;
    const Pace pace_;
    HapticTick& hand_;
    HandChannel& channel_;
    Output output_;

    std::mutex mutex_;
    std::condition_variable wake_;
    std::deque<Command> commands_;

    // The sand thread's own.
    sand::Replica terrain_;
    PathBuilder path_;
    StepClock clock_;
    FeltSand virtualSurface_;
    std::uint32_t session_ = 0;
    Start start_;
    enum class Phase { idle, awaitingState, running } phase_ = Phase::idle;
    sand::Edit edit_;  // for the next step
    std::uint64_t shown_ = 0;
    std::uint64_t virtualSteps_ = 0;  // made under the fast pace since the first start
    SandWatcher* watcher_ = nullptr;
    bool liftFirst_ = false;  // the first step of an epoch lifts a tool that was left in the sand
    bool stopping_ = false;
    std::atomic<std::uint64_t> withheld_{0}, dropped_{0};
    std::thread thread_;
};

}  // namespace haptic_bridge
