// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/guards/guards.hpp"

#include <algorithm>
#include <cmath>

#include "haptic_bridge/loop/guards/limited_law.hpp"

namespace haptic_bridge {

using sand::force::shortened;
using sand::force::Vec3;

namespace {

constexpr double kRounding = 1e-6;  // [s], so that ten ticks of 1 ms are kLate

/// Returns which part of a force is left after this `silence` [s] of a device that may only be late.
double leftAfter(double silence) { return silence < Guards::kLate - kRounding ? 1 - silence / Guards::kLate : 0; }

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
    const bool late = !reading.present && reading.silent && mayBeLate(reading.time);
    forces.acted = faults(reading, span, late, forces.lawful);
    const double left = fade(reading, span, late && forces.acted == 0);
    time_ = reading.time;
    place_ = late ? place_ : reading.place;
    const double share = share_.next(span, reading.share);
    if (mode_ == Mode::literal) {
        forces.acted &= bit(Guard::notANumber) | bit(Guard::lost);
        forces.acted |= late ? bit(Guard::unread) : 0;
        literal_ = (forces.acted & kFaults) != 0 ? Vec3{} : late ? left * literal_ : share * forces.lawful;
        forces.sent = literal_;
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

    if (late) {
        passivity_.wait(span);
        forces.sent = gate_.shorten(left);
        forces.acted = bit(Guard::unread);
        passivity_.sent(forces.sent);
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
    const Vec3 law = slew_.follow(wish.force, acted);
    wish.force = crossOver_.next({reading.time, reading.edited, reading.engaged, gate_.passed(), reading.place}, law);
    acted |= norm(wish.force - law) > 0 ? bit(Guard::edit) : 0;
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

bool Guards::mayBeLate(double time) const { return heard_ && silence_ + (time - time_) <= kLate + kRounding; }

/// Follows the silence of the device. Returns which part of the last force is left at this tick. `late`: the device may
/// only be late, and nothing else has failed.
double Guards::fade(const Reading& reading, double span, bool late) {
    heard_ = reading.present || late;
    const double before = leftAfter(silence_);
    silence_ = late ? silence_ + span : 0;
    return late && before > 0 ? leftAfter(silence_) / before : 0;
}

/// Returns one bit for each fault of this tick. After any fault no force is sent.
std::uint32_t Guards::faults(const Reading& reading, double span, bool late, Vec3 lawful) const {
    std::uint32_t acted = 0;
    const bool numbers = std::isfinite(norm(lawful)) && std::isfinite(norm(reading.place)) &&
                         std::isfinite(norm(reading.velocity)) && std::isfinite(reading.felt.stiffness) &&
                         std::isfinite(reading.talus) && std::isfinite(reading.share);
    acted |= numbers ? 0 : bit(Guard::notANumber);
    acted |= reading.present || late ? 0 : bit(Guard::lost);
    acted |= reading.tripped ? bit(Guard::tripped) : 0;
    acted |= reading.surfaceAge <= ForceLimits::kStaleSurface ? 0 : bit(Guard::stale);
    acted |= span >= 0 && span <= ForceLimits::kGap ? 0 : bit(Guard::missed);
    const double since = std::max(silence_ + span, ForceLimits::kTick);  // [s], the place before
    const double farthest = limits_.fastestThing * since + 2 * limits_.resolution;
    acted |= late || !(norm(reading.place - place_) > farthest) ? 0 : bit(Guard::jumped);
    return acted;
}

void Guards::restart(double time) {
    gate_.restart(time);
    slew_.restart();
    crossOver_.stop();
    passivity_.restart();
    damping_ = {};
}

void Guards::forget() {
    begun_ = heard_ = false;
    silence_ = 0;
    literal_ = {};
    share_ = {};
    frozen_ = FrozenSand(limits_.stepSeconds);
    late_ = LateStep(limits_);
}

}  // namespace haptic_bridge
