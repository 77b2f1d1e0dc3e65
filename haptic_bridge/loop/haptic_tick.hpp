// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/live_histogram.hpp"
#include "base/triple_buffer.hpp"
#include "haptic_bridge/hand/device.hpp"
#include "haptic_bridge/hand/hand_mapping.hpp"
#include "haptic_bridge/hand/path_builder.hpp"
#include "haptic_bridge/loop/guards/guards.hpp"
#include "haptic_bridge/loop/guards/velocity_window.hpp"
#include "haptic_bridge/loop/tick.hpp"
#include "sand/force/force_model.hpp"
#include "scene/scene.hpp"

namespace haptic_bridge {

/// Sand around the hand after a step, from which forces are computed.
struct FeltSand {
    sand::force::SurfacePatch patch;
    sand::ProbePoint around;    // of the patch: where the hand was when it was taken; the height does not count
    sand::force::Contour tool;  // which an operator may change
    std::uint64_t step = 0;     // number of the step that made it
    std::int64_t timeNs = 0;    // monotonic, of the step
};

/// One tick of the force loop: read the device, quantise, ask the law, guard, send.
///
/// A body's heights are metres, so they count from a level: over a surface that goes up and down with the hand, a
/// force would not be the one that its path works against. A recording is guarded as a Touch that reaches over the
/// whole field would be.
///
/// Used by one thread: the force thread in real time, the sand's own under a virtual clock. A tick asks for no memory
/// and waits for nobody.
class HapticTick {
public:
    static constexpr double kTick = ForceLimits::kTick;  // [s]

    HapticTick(const scene::Scene& scene, std::unique_ptr<Device> device, HandSettings::Datum datum,
               Guards::Mode mode = Guards::Mode::on);

    /// `deviceTime` [s] is what the device is read at; now and surface.timeNs are on one clock.
    HandSample tick(double deviceTime, std::int64_t nowNs, const FeltSand& surface);
    /// Reads the device and sends zero force. Called while no master is linked, so that troubles are reported and
    /// where() is known.
    void rest(double deviceTime);
    /// Forgets every tick before, as if it had just been made: what follows depends on the ticks of one link alone.
    void restart();

    /// All of the tick before, and what it was computed from: for the thread that ticks.
    [[nodiscard]] const Tick& lastTick() const { return tick_; }
    [[nodiscard]] const TickInput& lastInput() const { return input_; }
    [[nodiscard]] const Device& device() const { return *device_; }
    [[nodiscard]] HandSettings::Datum datum() const { return mapping_.datum(); }
    /// What was limited, and why: lines for a person.
    [[nodiscard]] const std::vector<std::string>& limitsInWords() const { return words_; }
    [[nodiscard]] const Guards& guards() const { return guards_; }
    [[nodiscard]] bool finished(double deviceTime) const { return device_->finished(deviceTime); }
    // Any thread:
    /// Returns where the hand was read last, at height 0; before that the middle of the field.
    [[nodiscard]] sand::ProbePoint where() const;
    [[nodiscard]] const base::LiveHistogram& forceCost() const {
        return forceCost_;
    }                                                                         // law and guards, of engaged ticks
    [[nodiscard]] const GuardCounts& guardCounts() const { return counts_; }  // [tick]

private:
    HapticTick(const scene::Scene& scene, std::unique_ptr<Device> device, HandSettings::Datum datum, Guards::Mode mode,
               const LawAtRadius& law);
    void fillTick(bool engaged);
    void tellWhere(const sand::ProbePoint& at);

    const sand::ForceConstants constants_;
    sand::force::ForceModel model_;
    std::unique_ptr<Device> device_;
    HandMapping mapping_;
    Guards guards_;
    VelocityWindow armVelocity_;  // [m/s], of the device's axes
    VelocityWindow velocity_;     // [scene unit/s]
    std::vector<std::string> words_;
    std::atomic<std::uint64_t> where_{0};  // x and y, 32 bits each: one value, so that no thread sees half of a place
    TickInput input_;
    Tick tick_;
    base::LiveHistogram forceCost_;
    GuardCounts counts_;
};

}  // namespace haptic_bridge
