// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/guards/passivity_observer.hpp"

#include <algorithm>

#include "haptic_bridge/hand/guard_counts.hpp"

namespace haptic_bridge {

using sand::force::Vec3;

namespace {

constexpr double kArmsShare = 0.75;
constexpr double kMemory = 0.5;  // [s]

}  // namespace

PassivityObserver::PassivityObserver(const ForceLimits& limits)
    : stiffness_(limits.lawStiffness),
      damping_(kArmsShare * limits.arm.damping),
      most_(limits.damping),
      // Two steps of the encoder under the greatest force count as noise.
      tolerance_(2 * limits.maxForce * limits.resolution),
      delay_(std::min(static_cast<std::size_t>(std::max(limits.arm.delayTicks, 0)), kMostDelay - 1)) {}

void PassivityObserver::wait(double span) {
    waited_ += span;
    impulse_ = impulse_ + span * acting();
}

void PassivityObserver::observe(Vec3 place, double last) {
    const double span = waited_ + last;
    if (begun_ && span > 0) {
        const Vec3 acted = waited_ > 0 ? (1 / span) * (impulse_ + last * acting()) : acting();
        const Vec3 way = place - place_;
        const double given = dot(acted, way);
        returned_ += given;
        // Uses the distance itself and not the velocity. An error of a coarse encoder then appears in both terms.
        surplus_ += given - damping_ * dot(way, way) / span;
    }
    begun_ = true;
    place_ = place;
    waited_ = 0;
    impulse_ = {};
    // The arm and the hand have taken the rest of an old surplus, so it no longer makes the loop less stable.
    surplus_ -= surplus_ > 0 ? std::clamp(span / kMemory, 0.0, 1.0) * surplus_ : 0;
}

Vec3 PassivityObserver::control(Vec3 velocity, std::uint32_t& acted) const {
    const double square = dot(velocity, velocity);
    if (!(surplus_ > tolerance_) || !(square > 0)) {
        return {};
    }
    acted |= bit(Guard::passivity);
    return -std::min(surplus_ / (square * ForceLimits::kTick), most_) * velocity;
}

void PassivityObserver::sent(Vec3 force) {
    newest_ = (newest_ + 1) % kMostDelay;
    sent_[newest_] = force;
    double greatest = 0;  // square of the greatest force that still acts or will act
    for (std::size_t ago = 0; ago <= delay_; ++ago) {
        const Vec3 under = sent_[(newest_ + kMostDelay - ago) % kMostDelay];
        greatest = std::max(greatest, dot(under, under));
    }
    surplus_ = std::max(surplus_, stiffness_ > 0 ? -greatest / (2 * stiffness_) : 0);
}

void PassivityObserver::restart() {
    sent_ = {};
    begun_ = false;
    waited_ = surplus_ = 0;
    impulse_ = {};
}

}  // namespace haptic_bridge
