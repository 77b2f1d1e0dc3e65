// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "haptic_bridge/hand/guard_counts.hpp"
#include "haptic_bridge/loop/guards/force_limits.hpp"
#include "haptic_bridge/loop/guards/passivity.hpp"
#include "haptic_bridge/loop/guards/slew.hpp"
#include "sand/force/force_model.hpp"

namespace haptic_bridge {

/// All guards between the law's force and the device, in the order of docs/forces.md. Used by one thread; allocates no
/// memory.
class Guards {
public:
    /// literal: sends the law of the paper without limits, which may damage a device. A force of 0 is sent only if a
    /// number is not finite or the device does not answer.
    enum class Mode : std::uint8_t { on, literal };

    explicit Guards(const ForceLimits& limits, Mode mode = Mode::on)
        : limits_(limits), mode_(mode), slew_(limits.slew), passivity_(limits) {}

    /// Input of the guards at one tick. Places and velocities are in metres of the device along the scene's axes.
    struct Reading {
        double time = 0;        // [s], time at which the device was read
        bool present = true;    // whether the device answers
        bool engaged = false;   // whether the tool may touch the sand
        double surfaceAge = 0;  // [s], age of the sand
        sand::force::Vec3 place, velocity;
        sand::force::Response felt;  // zero unless engaged
    };
    struct Forces {
        sand::force::Vec3 lawful, sent;  // [N]
        std::uint32_t acted = 0;         // one bit for each guard that acted
    };
    /// Returns the law's force and the force to be sent at this tick.
    [[nodiscard]] Forces tick(const Reading& reading);
    /// Forgets all ticks, so that the next one counts as the first.
    void forget() { begun_ = false; }

    [[nodiscard]] Mode mode() const { return mode_; }
    [[nodiscard]] const ForceLimits& limits() const { return limits_; }
    [[nodiscard]] const PassivityObserver& passivity() const { return passivity_; }

private:
    [[nodiscard]] std::uint32_t faults(const Reading& reading, double span, sand::force::Vec3 lawful) const;
    [[nodiscard]] sand::force::Vec3 limited(const Reading& reading, std::uint32_t& acted);
    void restart(double time);

    ForceLimits limits_;
    Mode mode_;
    Slew slew_;
    PassivityObserver passivity_;
    bool begun_ = false;
    double time_ = 0, rampFrom_ = 0;     // [s]
    sand::force::Vec3 place_, damping_;  // [m], [N]; the damping is that of the observer
};

}  // namespace haptic_bridge
