// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/guards/force_gate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "haptic_bridge/hand/guard_counts.hpp"

namespace haptic_bridge {

using sand::force::shortened;
using sand::force::Vec3;

Vec3 ForceGate::pass(const Wanted& wanted, std::uint32_t& acted) {
    // Every comparison below is false for a number that is not finite, so such numbers must not come further.
    if (!std::isfinite(norm(wanted.force)) || !std::isfinite(wanted.whole) || !std::isfinite(wanted.time)) {
        acted |= bit(Guard::notANumber);
        restart(wanted.time);
        return {};
    }
    if (!std::isfinite(rampFrom_)) {  // the fault before had no time
        rampFrom_ = wanted.time;
    }
    const double size = norm(wanted.force);
    const double share = ramped(wanted.time);
    acted |= share < 1 && size > 0 ? bit(Guard::ramp) : 0;
    const double most = mostInContact(wanted, share * wanted.whole);
    acted |= share * size > most ? bit(Guard::contact) : 0;
    acted |= size > maxForce_ ? bit(Guard::clamp) : 0;

    // In a ramp the device's greatest force grows too, so that no guard before can shorten the ramp.
    const Vec3 bounded = share * shortened(wanted.force, maxForce_);
    std::uint32_t followed = 0;
    const Vec3 pushed = follower_.follow(shortened(bounded, most), followed);
    acted |= followed != 0 ? bit(Guard::gate) : 0;
    pushed_ = norm(pushed);
    passed_ = pushed_ < norm(bounded) ? pushed_ / norm(bounded) : 1;
    return pushed;
}

Vec3 ForceGate::shorten(double share) {
    follower_.shorten(share);
    pushed_ = norm(follower_.last());
    passed_ *= share;
    return follower_.last();
}

void ForceGate::restart(double time) {
    rampFrom_ = time;
    follower_.restart();
    pushed_ = passed_ = 0;
    contact_ = grows_ = false;
}

/// Returns the share of the force that the ramp of a start or a fault allows at `time`.
double ForceGate::ramped(double time) const { return std::clamp((time - rampFrom_) / ForceLimits::kRamp, 0.0, 1.0); }

/// Returns the greatest force that a new contact or an edit allows [N]. `whole` is that of `wanted`, in its ramp.
double ForceGate::mostInContact(const Wanted& wanted, double whole) {
    const bool begins = wanted.contact && (!contact_ || wanted.edited);
    contact_ = wanted.contact;
    if (begins && whole > pushed_ + slew_) {
        grows_ = true;
        growsFrom_ = wanted.time;
        base_ = pushed_;
    }
    const double grown = (wanted.time - growsFrom_) / kContactSeconds;
    grows_ = grows_ && wanted.contact && grown < 1;
    // This bounds a growth. If the law asks for less than before, the force need not fall below the last one.
    return grows_ ? std::max(base_ + std::max(grown, 0.0) * std::max(whole - base_, 0.0), pushed_)
                  : std::numeric_limits<double>::infinity();
}

}  // namespace haptic_bridge
