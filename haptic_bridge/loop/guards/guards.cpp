// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/guards/guards.hpp"

#include <algorithm>
#include <cmath>

#include "haptic_bridge/loop/guards/limited_law.hpp"

namespace haptic_bridge {

using sand::force::Vec3;

namespace {

Vec3 shortened(Vec3 vector, double most) {
    const double size = norm(vector);
    return size > most ? (most / size) * vector : vector;
}

}  // namespace

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
    if (mode_ == Mode::literal) {
        forces.acted &= bit(Guard::notANumber) | bit(Guard::lost);
        forces.sent = forces.acted == 0 ? forces.lawful : Vec3{};
        return forces;
    }
    if (forces.acted != 0) {
        restart(reading.time);
        // Stale sand counts only while the tool touches it.
        forces.acted &= reading.engaged ? ~0U : ~bit(Guard::stale);
        return forces;
    }

    passivity_.observe(reading.place, span);
    forces.sent = limited(reading, forces.acted);
    passivity_.sent(forces.sent);
    return forces;
}

/// Returns the part of the law's force that may be sent, at a tick without faults. Adds a bit to `acted` for each guard
/// that acts.
Vec3 Guards::limited(const Reading& reading, std::uint32_t& acted) {
    Vec3 force;
    if (reading.engaged) {
        force = limitedForce(reading.felt, reading.velocity, limits_, acted);
    }
    force = slew_.follow(force, acted);
    // Damping may reduce a push, but must not turn it into a pull. It also grows no faster than a force may.
    const double pushed = std::max(dot(force, reading.felt.normal), 0.0);
    const Vec3 damping = pushed > 0 ? passivity_.control(reading.velocity, acted) : Vec3{};
    damping_ = shortened(damping_ + shortened(damping - damping_, limits_.slew / 2), pushed);
    acted |= norm(damping_) > 0 ? bit(Guard::passivity) : 0;
    force = force + damping_;
    const double size = norm(force);
    acted |= size > limits_.maxForce ? bit(Guard::clamp) : 0;
    force = shortened(force, limits_.maxForce);
    const double share = std::min((reading.time - rampFrom_) / ForceLimits::kRamp, 1.0);
    if (share < 1 && size > 0) {
        acted |= bit(Guard::ramp);
        force = share * force;
    }
    return force;
}

/// Returns one bit for each fault of this tick. After any fault no force is sent.
std::uint32_t Guards::faults(const Reading& reading, double span, Vec3 lawful) const {
    std::uint32_t acted = 0;
    const bool numbers = std::isfinite(norm(lawful)) && std::isfinite(norm(reading.place)) &&
                         std::isfinite(norm(reading.velocity)) && std::isfinite(reading.felt.stiffness);
    acted |= numbers ? 0 : bit(Guard::notANumber);
    acted |= reading.present ? 0 : bit(Guard::lost);
    acted |= reading.surfaceAge <= ForceLimits::kStaleSurface ? 0 : bit(Guard::stale);
    acted |= span >= 0 && span <= ForceLimits::kGap ? 0 : bit(Guard::missed);
    const double farthest = limits_.fastestThing * std::max(span, ForceLimits::kTick) + 2 * limits_.resolution;
    acted |= !(norm(reading.place - place_) > farthest) ? 0 : bit(Guard::jumped);
    return acted;
}

void Guards::restart(double time) {
    rampFrom_ = time;
    slew_.restart();
    passivity_.restart();
    damping_ = {};
}

}  // namespace haptic_bridge
