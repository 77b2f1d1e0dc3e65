// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/live_histogram.hpp"
#include "base/triple_buffer.hpp"
#include "haptic_bridge/hand/device.hpp"
#include "haptic_bridge/hand/hand_mapping.hpp"
#include "haptic_bridge/hand/hand_ticks.hpp"
#include "haptic_bridge/hand/held.hpp"
#include "haptic_bridge/hand/path_builder.hpp"
#include "haptic_bridge/loop/force_account.hpp"
#include "haptic_bridge/loop/guards/breaker.hpp"
#include "haptic_bridge/loop/guards/guards.hpp"
#include "haptic_bridge/loop/guards/velocity_window.hpp"
#include "haptic_bridge/loop/tick.hpp"
#include "sand/force/force_model.hpp"
#include "scene/model/scene.hpp"

namespace haptic_bridge {

/// Sand around the hand after one step. The forces are computed from it.
struct FeltSand {
    sand::force::SurfacePatch patch;
    sand::ProbePoint probe;     // of the hand when the patch was taken; z is 0
    sand::force::Contour tool;  // outline of the tool, which an operator may change
    double talus = 0;           // tangent of the sand's talus, which an operator may change
    std::uint64_t step = 0;     // number of the step after which the patch was taken
    std::uint64_t edits = 0;    // number of the link's steps with an edit, up to this step
    std::int64_t timeNs = 0;    // when the patch was published, on the clock of HapticTick::tick() [ns]
    std::int64_t stepNs = 0;    // from when on this step misses movement of the hand, or else madeNs [ns, same clock]
    std::int64_t madeNs = 0;    // when the patch of this step was first published, on the same clock [ns]
    std::optional<Held> held;   // of the wall's last frame; nullopt before its first frame
};

/// Runs the ticks of the force loop. A tick reads the device, quantises the pose, computes the law's force, guards it
/// and sends it.
///
/// An arm always uses the datum `level`. A datum that follows the surface would bend the arm's space, and a force would
/// then do work on a closed path of the hand.
///
/// A device without a body, such as a recording, gets the force limits of a Touch whose reach covers the whole field.
///
/// Threads: one thread ticks. In real time this is the force thread; under a virtual clock it is the sand thread. A
/// tick allocates no memory and never blocks.
class HapticTick {
public:
    static constexpr double kTick = ForceLimits::kTick;  // [s]

    /// `scene` must outlive this object. `datum` counts only for a device without a body.
    HapticTick(const scene::Scene& scene, std::unique_ptr<Device> device, HandSettings::Datum datum,
               Guards::Mode mode = Guards::Mode::on);
    /// Lets go.
    ~HapticTick();
    HapticTick(const HapticTick&) = delete;
    HapticTick& operator=(const HapticTick&) = delete;

    /// Runs one tick. Returns the quantised sample of the hand, from which the next step is made. If the pose is not
    /// finite or an arm does not answer, the sample hovers at the last place. While the answer may only be late, the
    /// tool stays as it was: to lift and to press it again would take two steps.
    ///
    /// @param deviceTime  Time at which the device is read [s], see Device::read().
    /// @param nowNs       Time of this tick [ns], on the same clock as surface.timeNs.
    /// @param surface     Sand that the hand feels in this tick.
    HandSample tick(double deviceTime, std::int64_t nowNs, const FeltSand& surface);
    /// Reads the device at `deviceTime` [s] and sends zero force. Called while no master is linked, so that the device
    /// still counts its troubles and probe() follows the hand.
    void rest(double deviceTime);
    /// Pushes 0, because an arm holds its last force until the next one. An exception of the device is dropped: it may
    /// be the reason why the hand lets go.
    void letGo() noexcept;
    /// Forgets all earlier ticks, except in the counters and in the Breaker. Called when a link begins. The forces of
    /// the link depend only on its own ticks and on TickInput::tripped.
    void restart();
    /// Sets the share of each force that the hand feels from now on, 0 to 1. The force changes to it in a ramp. Any
    /// thread.
    void shareForce(double share) { share_.store(share, std::memory_order_relaxed); }
    /// Allows force again after the Breaker has tripped. Called when an operator switches the force on. Any thread.
    void switchOn() { switchedOn_.store(true, std::memory_order_relaxed); }
    /// Sets whether the Breaker has tripped. Only for a replay.
    void trip(bool tripped) { breaker_.set(tripped); }

    /// Returns the last tick. Only for the thread that ticks.
    [[nodiscard]] const Tick& lastTick() const { return tick_; }
    /// Returns the input of the last tick. Only for the thread that ticks.
    [[nodiscard]] const TickInput& lastInput() const { return input_; }
    [[nodiscard]] const Device& device() const { return *device_; }
    [[nodiscard]] HandSettings::Datum datum() const { return mapping_.datum(); }
    /// Returns lines for the operator: the limits of the device's forces, and the reason for each.
    [[nodiscard]] const std::vector<std::string>& limitsInWords() const { return words_; }
    [[nodiscard]] const Guards& guards() const { return guards_; }
    [[nodiscard]] bool finished(double deviceTime) const { return device_->finished(deviceTime); }

    /// Returns the probe point of the last reading, with z = 0; before the first reading, the centre of the field. Any
    /// thread.
    [[nodiscard]] sand::ProbePoint probe() const;
    /// Returns how long the law and the guards took in each engaged tick [ns]. Any thread.
    [[nodiscard]] const base::LiveHistogram& forceCost() const { return forceCost_; }
    /// Returns the number of ticks in which each guard acted. Any thread.
    [[nodiscard]] const GuardCounts& guardCounts() const { return counts_; }
    /// Returns the number of calls of tick(), and what the hand got in them. Any thread.
    [[nodiscard]] const HandTicks& handTicks() const { return ticks_; }
    /// Returns whether the Breaker has tripped, as of the last tick. Any thread.
    [[nodiscard]] bool tripped() const { return tripped_.load(std::memory_order_relaxed); }

private:
    HapticTick(const scene::Scene& scene, std::unique_ptr<Device> device, HandSettings::Datum datum, Guards::Mode mode,
               const LawAtRadius& law);
    void fillTick(bool engaged);
    void count(const FeltSand& surface, const Guards::Reading& reading);
    void followHand(bool late);
    [[nodiscard]] bool mayNotPush();
    [[nodiscard]] bool feelsEdit(const FeltSand& surface);
    void setProbe(const sand::ProbePoint& probe);
    void push(sand::force::Vec3 force);

    const sand::ForceConstants constants_;
    sand::force::ForceModel model_;
    std::unique_ptr<Device> device_;
    HandMapping mapping_;
    double probeUnit_;  // [scene unit]
    Guards guards_;
    VelocityWindow armVelocity_;  // [m/s], along the arm's own axes
    VelocityWindow velocity_;     // [scene unit/s]
    std::vector<std::string> words_;
    std::atomic<std::uint64_t> probe_{0};  // x and y, 32 bits each; one value, so that no thread reads half of it
    std::atomic<double> share_{1};
    std::atomic<bool> switchedOn_{false};
    std::atomic<bool> tripped_{false};  // as breaker_, for other threads
    Breaker breaker_;
    std::optional<std::uint64_t> edits_;  // FeltSand::edits at the last tick; nullopt before the first
    TickInput input_;
    Tick tick_;
    base::LiveHistogram forceCost_;
    GuardCounts counts_;
    ForceAccount account_;
    HandTicks ticks_;
};

}  // namespace haptic_bridge
