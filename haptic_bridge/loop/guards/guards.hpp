// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "haptic_bridge/hand/guard_counts.hpp"
#include "haptic_bridge/loop/guards/cross_over.hpp"
#include "haptic_bridge/loop/guards/felt_share.hpp"
#include "haptic_bridge/loop/guards/force_gate.hpp"
#include "haptic_bridge/loop/guards/force_limits.hpp"
#include "haptic_bridge/loop/guards/frozen_sand.hpp"
#include "haptic_bridge/loop/guards/late_step.hpp"
#include "haptic_bridge/loop/guards/passivity_observer.hpp"
#include "haptic_bridge/loop/guards/slew.hpp"
#include "sand/force/force_model.hpp"

namespace haptic_bridge {

/// All guards between the law's force and the device, in the order of docs/forces.md. The last one is the ForceGate.
/// Used by one thread; allocates no memory.
class Guards {
public:
    /// literal: sends the law of the paper without limits, which may damage a device, so that only a simulated arm or a
    /// recording may get it. A force of 0 is sent only if a number is not finite or the device does not answer.
    ///
    /// A device that gives no reading may only be late. Its force fades within kLate. If the silence lasts longer, the
    /// device has failed.
    static constexpr double kLate = 0.01;  // [s]
    enum class Mode : std::uint8_t { on, literal };

    explicit Guards(const ForceLimits& limits, Mode mode = Mode::on)
        : limits_(limits), mode_(mode), slew_(limits.slew), crossOver_(limits), passivity_(limits), gate_(limits) {
        forget();
    }
    Guards(const Guards&) = delete;
    Guards& operator=(const Guards&) = delete;

    /// Input of the guards at one tick. Places and velocities are in metres of the device along the scene's axes.
    struct Reading {
        double time = 0;        // [s], time at which the device was read
        bool present = true;    // whether the device gave a plausible reading
        bool silent = false;    // the device gave no reading; place, velocity and `felt` then only have to be finite
        bool tripped = false;   // no force may be sent, because too many faults came (Breaker)
        bool engaged = false;   // whether the tool may touch the sand
        bool edited = false;    // whether this is the first tick that feels a step with an edit
        double surfaceAge = 0;  // [s], since the sand was copied
        double stepAge = 0;     // [s], since the newest step was made
        double share = 1;       // of each force that the hand may feel now, 0 to 1; 0 while the clutch is held
        double talus = 0;       // tangent of the talus of the sand at the hand
        sand::force::Vec3 place, velocity;
        sand::force::Response felt;  // zero unless engaged
    };
    struct Forces {
        sand::force::Vec3 lawful, sent;  // [N]; sent: what the gate passed
        std::uint32_t acted = 0;         // one bit for each guard that acted
    };
    /// Returns the law's force and the force to be pushed at this tick.
    [[nodiscard]] Forces tick(const Reading& reading);
    /// Forgets all ticks, so that the next one counts as the first.
    void forget();

    /// Returns whether a device that gives no reading at `time` [s] may only be late.
    [[nodiscard]] bool mayBeLate(double time) const;

    [[nodiscard]] Mode mode() const { return mode_; }
    [[nodiscard]] const ForceLimits& limits() const { return limits_; }
    [[nodiscard]] const PassivityObserver& passivity() const { return passivity_; }

private:
    [[nodiscard]] std::uint32_t faults(const Reading& reading, double span, bool late, sand::force::Vec3 lawful) const;
    [[nodiscard]] double fade(const Reading& reading, double span, bool late);
    [[nodiscard]] ForceGate::Wanted wanted(const Reading& reading, double share, double softness, std::uint32_t& acted);
    void restart(double time);

    ForceLimits limits_;
    Mode mode_;
    Slew slew_;
    CrossOver crossOver_;
    PassivityObserver passivity_;
    FeltShare share_;
    FrozenSand frozen_{limits_.stepSeconds};
    LateStep late_{limits_};
    ForceGate gate_;
    bool begun_ = false;
    bool heard_ = false;                 // the device has given a reading, and no fault has come since it fell silent
    double time_ = 0;                    // [s]
    double silence_ = 0;                 // [s], since the last reading; 0 unless the device may only be late
    sand::force::Vec3 place_, damping_;  // [m], [N]; the damping is that of the observer
    sand::force::Vec3 literal_;          // [N], the last force of Mode::literal
};

}  // namespace haptic_bridge
