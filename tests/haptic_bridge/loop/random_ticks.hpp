// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "haptic_bridge/loop/guards/guards.hpp"
#include "tests/haptic_bridge/loop/dice.hpp"

namespace test {

inline double& partOf(sand::force::Vec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// Random ticks of a gate. In one sequence the ticks have about the same span, so that some see a whole ramp.
class GateTicks {
public:
    GateTicks(Dice& dice, const haptic_bridge::ForceLimits& limits)
        : dice_(dice), limits_(limits), span_(dice.scaled(1e-4, 0.05)), time_(dice.between(-10, 10)) {}

    [[nodiscard]] double time() const { return time_; }
    [[nodiscard]] haptic_bridge::ForceGate::Wanted next() {
        time_ = dice_.chance(0.02) ? dice_.between(-10, 10) : std::isfinite(time_) ? time_ + span_ : 0;
        if (dice_.chance(0.3)) {  // another force, as a tool that an edit buries
            force_ = dice_.vector(2 * limits_.maxForce * dice_.scaled(1e-4, 1));
        } else {
            force_ = force_ + dice_.vector(limits_.slew * dice_.scaled(0.01, 10));
        }
        contact_ = dice_.chance(0.1) ? !contact_ : contact_;
        const double whole = dice_.chance(0.1) ? dice_.between(0, limits_.maxForce) : norm(force_);
        haptic_bridge::ForceGate::Wanted wanted{time_, force_, whole, contact_, dice_.chance(0.1)};
        if (dice_.chance(0.03)) {
            spoil(wanted);
        }
        return wanted;
    }

private:
    void spoil(haptic_bridge::ForceGate::Wanted& wanted) {
        switch (dice_.below(3)) {
            case 0:
                time_ = wanted.time = dice_.odd();
                break;
            case 1:
                wanted.whole = dice_.odd();
                break;
            default:
                partOf(wanted.force, dice_.below(3)) = dice_.odd();
                break;
        }
    }

    Dice& dice_;
    const haptic_bridge::ForceLimits& limits_;
    double span_, time_;  // [s]
    sand::force::Vec3 force_;
    bool contact_ = false;
};

/// Random readings of a hand. Most are those of an honest hand; some are spoilt.
class HandTicks {
public:
    HandTicks(Dice& dice, const haptic_bridge::ForceLimits& limits)
        : dice_(dice), limits_(limits), span_(dice.chance(0.9) ? dice.scaled(1e-4, 9.9e-3) : dice.scaled(1e-4, 0.02)) {
        reading_.time = dice.between(-10, 10);
        reading_.share = dice.oneOf({0.0, 0.3, 1.0, 1.0});
        reading_.talus = dice.between(0, 1.5);
        press();
    }

    [[nodiscard]] const haptic_bridge::Guards::Reading& honest() {
        goOn(span_);
        reading_.edited = dice_.chance(0.04);
        reading_.place = reading_.place + dice_.vector(2 * span_);
        reading_.velocity = dice_.chance(0.2) ? dice_.vector(dice_.scaled(1e-3, 5)) : reading_.velocity;
        reading_.engaged = dice_.chance(0.08) ? !reading_.engaged : reading_.engaged;
        reading_.share = dice_.chance(0.04) ? dice_.oneOf({0.0, 0.0, 0.3, 1.0, 1.0}) : reading_.share;
        // A wall that stands still now and then, so that the newest step grows old.
        paused_ = dice_.chance(0.04) ? !paused_ : paused_;
        reading_.stepAge = paused_ ? reading_.stepAge + span_ : dice_.between(0, limits_.stepSeconds);
        reading_.surfaceAge = dice_.chance(0.01) ? dice_.between(0, 0.1) : dice_.between(0, 0.01);
        if (dice_.chance(0.1)) {
            press();
        } else {
            reading_.felt.push = dice_.between(0.95, 1.05) * reading_.felt.push;
        }
        return reading_;
    }
    [[nodiscard]] haptic_bridge::Guards::Reading next() {
        haptic_bridge::Guards::Reading reading = honest();
        // A device that gives no reading for a while.
        silent_ = dice_.chance(0.02) ? 1 + dice_.below(4) : std::max(silent_ - 1, 0);
        reading.present = silent_ == 0;
        reading.silent = silent_ > 0;
        reading.edited = reading.edited && reading.present;
        if (dice_.chance(0.02)) {
            spoil(reading);
        }
        return reading;
    }
    /// Returns the reading of a hand that rests in the sand, 9 ms later. Its force fades in.
    [[nodiscard]] const haptic_bridge::Guards::Reading& resting() {
        goOn(9e-3);
        reading_.surfaceAge = reading_.stepAge = 0;
        reading_.share = 1;
        reading_.edited = false;
        reading_.engaged = true;
        reading_.velocity = {};
        return reading_;
    }

private:
    void goOn(double span) {
        reading_.time = std::abs(reading_.time) < 1e3 ? reading_.time + span : dice_.between(-10, 10);
    }
    /// Another place in the sand: another push, as steep and as rough as any law is.
    void press() {
        const sand::force::Vec3 up = dice_.vector(1) + sand::force::Vec3{0, 0, 1.1};
        reading_.felt.normal = (1 / norm(up)) * up;
        const double size = limits_.maxForce / std::max(limits_.gain, 1e-300) * dice_.scaled(1e-3, 100);
        reading_.felt.push = dice_.chance(0.2) ? sand::force::Vec3{} : std::min(size, 1e100) * reading_.felt.normal;
        reading_.felt.stiffness = dice_.scaled(1e-3, 1e6);
        reading_.felt.drag = dice_.scaled(1e-3, 1e6);
    }
    void spoil(haptic_bridge::Guards::Reading& reading) {
        const double odd = dice_.odd();
        switch (dice_.below(13)) {
            case 0:
                reading_.time = reading.time = odd;
                break;
            case 1:
                reading.present = false;
                break;
            case 2:
                reading.surfaceAge = odd;
                break;
            case 3:
                reading.stepAge = odd;
                break;
            case 4:
                reading.share = odd;
                break;
            case 5:
                reading.talus = std::isnan(odd) ? odd : std::abs(odd);
                break;
            case 6:
                partOf(reading.place, dice_.below(3)) = odd;
                break;
            case 7:
                partOf(reading.velocity, dice_.below(3)) = odd;
                break;
            case 8:
                partOf(reading.felt.push, dice_.below(3)) = odd;
                break;
            case 9:
                partOf(reading.felt.normal, dice_.below(3)) = odd;
                break;
            case 10:
                reading.felt.stiffness = odd;
                break;
            case 11:
                reading.tripped = true;
                break;
            default:
                reading.felt.drag = odd;
                break;
        }
    }

    Dice& dice_;
    const haptic_bridge::ForceLimits& limits_;
    double span_;  // [s]
    bool paused_ = false;
    int silent_ = 0;  // [tick], until a reading comes
    haptic_bridge::Guards::Reading reading_;
};

}  // namespace test
