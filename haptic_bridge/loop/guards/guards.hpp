// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "haptic_bridge/hand/guard_counts.hpp"
#include "haptic_bridge/loop/guards/force_limits.hpp"
#include "haptic_bridge/loop/guards/passivity.hpp"
#include "haptic_bridge/loop/guards/slew.hpp"
#include "sand/force/force_model.hpp"

namespace haptic_bridge {

/// Everything between what the sand answers and what a device gets, in the order of docs/forces.md. Used by one thread;
/// asks for no memory.
class Guards {
public:
    /// literal: the law as its paper has it, whatever that does to a device; only what is no number is not sent.
    enum class Mode : std::uint8_t { on, literal };

    explicit Guards(const ForceLimits& limits, Mode mode = Mode::on)
        : limits_(limits), mode_(mode), slew_(limits.slew), passivity_(limits) {}

    /// What one tick knows. Places and velocities are metres of the device along the scene's axes.
    struct Reading {
        double time = 0;        // [s], of the loop's clock
        bool present = true;    // the device answers
        bool engaged = false;   // and may touch the sand
        double surfaceAge = 0;  // [s]
        sand::force::Vec3 place, velocity;
        sand::force::Response felt;  // of nothing unless engaged
    };
    struct Forces {
        sand::force::Vec3 lawful, sent;  // [N]
        std::uint32_t acted = 0;         // a bit for each guard
    };
    [[nodiscard]] Forces tick(const Reading& reading);
    /// The next tick is the first again.
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
    sand::force::Vec3 place_, damping_;  // [m], [N] of the observer's
};

}  // namespace haptic_bridge
