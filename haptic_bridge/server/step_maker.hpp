// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "haptic_bridge/link/protocol.hpp"
#include "haptic_bridge/loop/hand_feed.hpp"
#include "haptic_bridge/server/step_clock.hpp"
#include "host/clock.hpp"
#include "sand/replica.hpp"
#include "scene/scene.hpp"

namespace haptic_bridge {

/// Owns the server's replica, and numbers the steps from a master's Start to its end.
///
/// Has no thread of its own, and is used by one.
class StepMaker {
public:
    // A wall that cannot keep up shows the hand late, by the steps in its queue. With 32 steps that was a second.
    static constexpr std::uint64_t kWindow = 8;  // [step] that may be ahead of the wall

    /// Callbacks that send to a master; `session` is the one given to start().
    struct Output {
        std::function<void(std::uint32_t session)> ready;
        std::function<void(std::uint32_t session, NeedState need)> needState;
        std::function<void(std::uint32_t session, std::string why)> unusable;  // the state sent does not fit
        std::function<void(std::uint32_t session, base::Bytes stepMessage)> step;
    };

    using Clock = std::function<std::int64_t()>;  // [ns], monotonic

    StepMaker(const scene::Scene& scene, HandFeed& hand, Output output, const sand::grid::Erosion::Options& sweeps = {},
              Clock clock = host::monotonicNs);

    /// A master hands over the numbering. Without the same sand here, it is asked for state() or catchUp().
    void start(std::uint32_t session, const Start& start);
    void state(const base::Bytes& bytes);
    void catchUp(const CatchUp& steps);
    void shown(const Shown& frame, std::int64_t nowNs);
    void edit(EditRequest request) { edit_ = std::move(request.edit); }
    void release();

    /// Takes the samples of the hand since the last call, also while no master is linked.
    void collect();
    /// Makes the next step. Withholds it if the wall is a whole window behind. Call it while running().
    void makeStep();

    [[nodiscard]] const sand::Replica& sand() const { return terrain_; }
    [[nodiscard]] bool running() const { return phase_ == Phase::running; }
    /// Whether the wall is a whole window behind.
    [[nodiscard]] bool blocked() const { return terrain_.stepNumber() >= shown_ + kWindow; }
    [[nodiscard]] std::int64_t due() const { return clock_.due(); }  // [ns], of the next step in real time
    // Any thread:
    [[nodiscard]] std::uint64_t withheld() const { return withheld_; }  // steps, over the program's life
    [[nodiscard]] std::uint64_t dropped() const { return dropped_; }    // samples

private:
    [[nodiscard]] bool asGranted();
    void begin();
    [[nodiscard]] std::int64_t fill(sand::Step& step);

    HandFeed& hand_;
    Output output_;
    sand::Replica terrain_;
    PathBuilder path_;
    Clock now_;
    StepClock clock_;
    std::uint32_t session_ = 0;
    Start start_;
    enum class Phase { idle, awaitingState, running } phase_ = Phase::idle;
    sand::Edit edit_;  // for the next step
    std::uint64_t shown_ = 0;
    bool liftFirst_ = false;  // the first step of an epoch lifts a tool that was left in the sand
    std::atomic<std::uint64_t> withheld_{0}, dropped_{0};
};

}  // namespace haptic_bridge
