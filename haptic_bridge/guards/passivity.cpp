// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/guards/passivity.hpp"

#include <algorithm>

#include "haptic_bridge/guards/guard.hpp"

namespace haptic_bridge {

using sand::force::Vec3;

namespace {

constexpr double kArmsShare = 0.75;

}  // namespace

PassivityObserver::PassivityObserver(const ForceLimits& limits)
    : stiffness_(limits.lawStiffness),
      damping_(kArmsShare * limits.arm.damping),
      most_(limits.damping),
      // One step of the encoder under the greatest force is noise, not energy.
      tolerance_(limits.maxForce * limits.resolution),
      delay_(std::min(static_cast<std::size_t>(std::max(limits.arm.delayTicks, 0)), kMostDelay - 1)) {}

void PassivityObserver::observe(Vec3 place, Vec3 velocity, double span) {
    if (begun_) {
        const Vec3 acted = sent_[(newest_ + kMostDelay - delay_) % kMostDelay];
        const double given = dot(acted, place - place_);
        returned_ += given;
        surplus_ += given - damping_ * dot(velocity, velocity) * span;
    }
    begun_ = true;
    place_ = place;
    const Vec3 last = sent_[newest_];
    const double held = stiffness_ > 0 ? dot(last, last) / (2 * stiffness_) : 0;
    surplus_ = std::max(surplus_, -held);
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
}

void PassivityObserver::restart() {
    sent_ = {};
    begun_ = false;
    surplus_ = 0;
}

}  // namespace haptic_bridge
