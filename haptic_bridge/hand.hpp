// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "haptic_bridge/devices/device.hpp"
#include "haptic_bridge/hand_mapping.hpp"
#include "haptic_bridge/latest.hpp"
#include "haptic_bridge/live_histogram.hpp"
#include "haptic_bridge/path_builder.hpp"
#include "sand/force/force_model.hpp"

namespace haptic_bridge {

/// The sand around the tool after a step, for whoever computes forces.
struct Surface {
    sand::force::SurfacePatch patch;
    sand::force::Contour tool;  // which an operator may change
    std::uint64_t step = 0;     // number of the step that made it
    std::int64_t timeNs = 0;    // monotonic, of the step
};

/// One tick of the force loop: read the device, quantise, compute the force, send it.
///
/// Used by one thread: the force thread in real time, the sand's own under a virtual clock.
class Hand {
public:
    static constexpr double kTick = 1e-3;  // [s]

    Hand(const sand::Scene& scene, std::unique_ptr<Device> device, HandSettings::Datum datum);

    /// `deviceTime` [s] is what the device is read at; now and surface.timeNs are on one clock.
    HandSample tick(double deviceTime, std::int64_t nowNs, const Surface& surface);

    [[nodiscard]] const LiveHistogram& forceCost() const { return forceCost_; }  // any thread
    [[nodiscard]] bool finished(double deviceTime) const { return device_->finished(deviceTime); }

private:
    void updateVelocity(double deviceTime, sand::force::Vec3 place);

    sand::force::ForceModel model_;
    std::unique_ptr<Device> device_;
    HandMapping mapping_;
    sand::ProbePoint last_;
    // Velocity over a window of 15 ticks: a difference over one tick is mostly the device's resolution.
    static constexpr std::size_t kWindow = 16;
    std::array<std::pair<double, sand::force::Vec3>, kWindow> places_{};
    std::size_t ticks_ = 0;
    sand::force::Vec3 velocity_;  // [scene unit per 1/60 s]
    LiveHistogram forceCost_;
};

}  // namespace haptic_bridge
