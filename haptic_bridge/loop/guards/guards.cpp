// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/guards/guards.hpp"

#include <algorithm>
#include <cmath>

#include "haptic_bridge/loop/guards/limited_law.hpp"

namespace haptic_bridge {

using sand::force::shortened;
using sand::force::Vec3;

Guards::Forces Guards::tick(const Reading& reading) {
    Forces forces;
    if (reading.engaged) {
        forces.lawful = lawfulForce(reading.felt, reading.velocity, limits_.scale);
    }
    if (!begun_) {
        begun_ = true;
        time_ = reading.time;
        place_ = reading.place;
        restart(reading.time);
    }
    const double span = reading.time - time_;
    forces.acted = faults(reading, span, forces.lawful);
    time_ = reading.time;
    place_ = reading.place;
    const double share = share_.next(span, reading.share);
    if (mode_ == Mode::literal) {
        forces.acted &= bit(Guard::notANumber) | bit(Guard::lost);
        forces.sent = forces.acted == 0 ? share * forces.lawful : Vec3{};
        return forces;
    }
    const double moving = frozen_.next(span, reading.stepAge);
    const double softness = late_.next(span, reading.stepAge);
    if (forces.acted != 0) {
        restart(reading.time);
        // Stale sand counts only while the tool touches it.
        forces.acted &= reading.engaged ? ~0U : ~bit(Guard::stale);
        return forces;
    }

    passivity_.observe(reading.place, span);
    ForceGate::Wanted wish = wanted(reading, share * moving, softness, forces.acted);
    forces.acted |= moving < 1 && wish.contact ? bit(Guard::frozen) : 0;
    forces.sent = gate_.pass(wish, forces.acted);
    passivity_.sent(forces.sent);
    return forces;
}

/// Returns what the gate gets at a tick without faults: the part of the law's force that the device can bear, times
/// `share`. `softness` lowers the stiffness. Adds a bit to `acted` for each guard that acts.
ForceGate::Wanted Guards::wanted(const Reading& reading, double share, double softness, std::uint32_t& acted) {
    ForceGate::Wanted wish{reading.time, {}, 0, false, reading.edited};
    if (reading.engaged) {
        wish.force = limitedForce(reading.felt, reading.velocity, LimitsNow(limits_, softness, reading.talus), acted);
    }
    const double limited = norm(wish.force);
    wish.contact = limited > 0;
    wish.whole = share * std::min(limited, limits_.maxForce);
    wish.force = slew_.follow(wish.force, acted);
    // Damping may reduce a push, but must not turn it into a pull. It also grows no faster than a force may.
    const double pushed = std::max(dot(wish.force, reading.felt.normal), 0.0);
    const Vec3 damping = pushed > 0 ? passivity_.control(reading.velocity, acted) : Vec3{};
    damping_ = shortened(damping_ + shortened(damping - damping_, limits_.slew / 2), pushed);
    acted |= norm(damping_) > 0 ? bit(Guard::passivity) : 0;
    wish.force = wish.force + damping_;
    acted |= norm(wish.force) > limits_.maxForce ? bit(Guard::clamp) : 0;
    // The share is that of the force that the device can produce.
    wish.force = share * shortened(wish.force, limits_.maxForce);
    return wish;
}

/// Returns one bit for each fault of this tick. After any fault no force is sent.
std::uint32_t Guards::faults(const Reading& reading, double span, Vec3 lawful) const {
    std::uint32_t acted = 0;
    const bool numbers = std::isfinite(norm(lawful)) && std::isfinite(norm(reading.place)) &&
                         std::isfinite(norm(reading.velocity)) && std::isfinite(reading.felt.stiffness) &&
                         std::isfinite(reading.talus) && std::isfinite(reading.share);
    acted |= numbers ? 0 : bit(Guard::notANumber);
    acted |= reading.present ? 0 : bit(Guard::lost);
    acted |= reading.surfaceAge <= ForceLimits::kStaleSurface ? 0 : bit(Guard::stale);
    acted |= span >= 0 && span <= ForceLimits::kGap ? 0 : bit(Guard::missed);
    const double farthest = limits_.fastestThing * std::max(span, ForceLimits::kTick) + 2 * limits_.resolution;
    acted |= !(norm(reading.place - place_) > farthest) ? 0 : bit(Guard::jumped);
    return acted;
}

void Guards::restart(double time) {
    gate_.restart(time);
    slew_.restart();
    passivity_.restart();
    damping_ = {};
}

void Guards::forget() {
    begun_ = false;
    share_ = {};
    frozen_ = FrozenSand(limits_.stepSeconds);
    late_ = LateStep(limits_);
}

}  // namespace haptic_bridge
