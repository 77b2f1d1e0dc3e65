// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "haptic_bridge/hand/sweep_budget.hpp"
#include "haptic_bridge/link/protocol.hpp"
#include "haptic_bridge/loop/device_hand.hpp"
#include "haptic_bridge/server/step_clock.hpp"
#include "host/clock.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"

namespace haptic_bridge {

/// Makes and numbers the steps of a haptic server, and owns the server's replica.
///
/// An epoch begins when a master sends Start and the replica has the same sand. It ends with release(). Until then,
/// makeStep() puts the samples of the hand into a step and applies the step to the replica. It sends the step to the
/// master, with the replica's state hash, and gives the hand the sand after the step. While sweeps are owed, the steps
/// only pay them, and the movement of the hand waits.
///
/// Threads: one thread calls it, except where a function allows any thread. It has no thread of its own.
class StepMaker {
public:
    // A wall that cannot keep up shows the hand late, by the steps of a window. With 32 steps that was a second.
    static constexpr std::uint64_t kWindow = 8;  // [step], largest lead of the server over the wall

    /// Callbacks that send messages to a master. `session` is the number that start() got.
    struct Output {
        std::function<void(std::uint32_t session)> ready;                      // Ready
        std::function<void(std::uint32_t session, NeedState need)> needState;  // NeedState
        std::function<void(std::uint32_t session, std::string why)> unusable;  // a Refusal: its sand does not fit
        // An encoded StepMessage. `edit` is the number of the edit in it, or 0.
        std::function<void(std::uint32_t session, base::Bytes stepMessage, std::uint64_t edit)> step;
        std::function<void(std::uint32_t session, Audited result)> audited = [](auto, auto) {};  // answers audit()
    };

    using Clock = std::function<std::int64_t()>;  // [ns], monotonic

    /// `replica` is the scene's sand. `hand` must outlive this object.
    StepMaker(sand::Replica replica, DeviceHand& hand, Output output, Clock clock = host::monotonicNs);

    /// Begins the master's epoch if the replica has the sand of `start`. Otherwise asks the master for that sand, and
    /// waits for state() or catchUp().
    void start(std::uint32_t session, const StartMessage& start);
    /// Loads the sand of a State and begins the epoch. Reports `unusable` if this is not the sand of Start, or if this
    /// machine has no memory for it. Ignored unless it was asked for.
    void state(const base::Bytes& bytes);
    /// Applies the steps of a CatchUp. Begins the epoch after the last CatchUp, or asks for a State if the steps do not
    /// lead to the sand of Start. It asks once, and ignores later CatchUps. Ignored unless it was asked for.
    void catchUp(const CatchUp& steps);
    /// Takes a Shown that arrived at `nowNs` [ns]. The window moves to the step that the wall shows, and the step clock
    /// follows the wall's frames.
    void shown(const Shown& frame, std::int64_t nowNs);
    /// Puts an edit into the next step. Replaces an edit that still waits. Reports `unusable` if the edit loads sand
    /// that does not fit the scene, or that this machine has no memory for. Ignored while no epoch runs.
    void edit(EditRequest request);
    /// Hashes the whole sand again from memory, and reports `audited`: whether it still has the state hash that was
    /// sent with its last step. Called when a link ends in an orderly way. Ignored while no epoch runs.
    void audit();
    /// Ends the epoch, because the master has left. The hand rests, and samples that still wait are dropped.
    void release();

    /// Takes the samples of the hand since the last call. makeStep() puts them into a step. While no epoch
    /// runs, they are dropped.
    void collect();
    /// Makes the next step and sends it. Withholds it while blocked(); the hand then keeps feeling the same sand. Call
    /// this only while running().
    void makeStep();
    /// Gives the hand the same sand again if it has not got any for DeviceHand::kRefreshNs. Call this at least as
    /// often.
    void refresh();

    [[nodiscard]] const sand::Replica& sand() const { return replica_; }
    /// Returns whether an epoch runs.
    [[nodiscard]] bool running() const { return phase_ == Phase::running; }
    /// Returns whether the wall is kWindow steps behind.
    [[nodiscard]] bool blocked() const { return replica_.stepNumber() >= shown_ + kWindow; }
    /// Returns when the next step is due in real time [ns].
    [[nodiscard]] std::int64_t due() const { return clock_.due(); }
    /// Returns how many steps were withheld since the program started, by cause. Any thread.
    [[nodiscard]] WithheldCounts withheld() const;
    /// Returns how many hand samples of running epochs were dropped since the program started. Any thread.
    [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

private:
    [[nodiscard]] bool asGranted();
    [[nodiscard]] Withheld cause() const;
    void begin();
    [[nodiscard]] std::int64_t fill(sand::Step& step);

    DeviceHand& hand_;
    Output output_;
    sand::Replica replica_;
    Clock now_;
    StepClock clock_;
    SweepBudget budget_;
    std::uint32_t session_ = 0;
    StartMessage start_;
    enum class Phase { idle, awaitingState, running } phase_ = Phase::idle;
    bool asksForSand_ = false;  // steps did not lead to the sand of Start, and the whole sand was asked for
    sand::Edit edit_;           // of the next step
    std::uint64_t shown_ = 0;   // number of the step that the wall shows
    std::optional<Held> held_;  // of the last Shown; nullopt before the first of this epoch
    std::array<std::atomic<std::uint64_t>, valuesOf(Withheld{}).size()> withheld_{};
    std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace haptic_bridge
