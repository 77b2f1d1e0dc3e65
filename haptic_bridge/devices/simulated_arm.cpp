// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/devices/simulated_arm.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptic_bridge {

using sand::force::Vec3;

SimulatedArm::SimulatedArm(const ArmPhysics& physics, Grip grip, Path path)
    : physics_(physics), body_{physics.mass, physics.damping, physics.friction, grip}, path_(std::move(path)) {
    if (!path_) {
        body_.grip = {};
    }
}

ArmReading SimulatedArm::read(double time) {
    if (!begun_) {
        begun_ = true;
        time_ = time;
        if (path_) {
            target_ = path_(time);
            start(target_.place, {});
        }
    }
    if (time > time_) {
        const Target from = target_;
        const double began = time_, span = time - began;
        const Target to = path_ ? path_(time) : Target{};
        const Vec3 speed = (1 / span) * (to.place - from.place);
        while (waiting_ > 0 && pending_[oldest_].due <= time) {
            const Pending next = pending_[oldest_];
            target_ = {from.place + (time_ - began) * speed, to.touches};
            advanceTo(std::max(next.due, time_), speed);
            acting_ = next.force;
            oldest_ = (oldest_ + 1) % kMostPending;
            --waiting_;
        }
        target_ = {from.place + (time_ - began) * speed, to.touches};
        advanceTo(time, speed);
        target_ = to;
    }
    const auto encoded = [this](double x) {
        const double unit = physics_.resolution;
        return unit > 0 ? std::floor(x / unit + 0.5) * unit : x;
    };
    const Vec3 at = place();
    return {{encoded(at.x), encoded(at.y), encoded(at.z)}, target_.touches, false, true};
}

void SimulatedArm::push(Vec3 force) {
    const double size = norm(force);
    if (!std::isfinite(size)) {
        force = {};
    } else if (size > physics_.maxForce) {
        force = (physics_.maxForce / size) * force;
    }
    if (physics_.delayTicks <= 0) {
        acting_ = force;
        return;
    }
    if (waiting_ == kMostPending) {  // pushed far more often than read: the oldest force acts at once
        acting_ = pending_[oldest_].force;
        oldest_ = (oldest_ + 1) % kMostPending;
        --waiting_;
    }
    pending_[(oldest_ + waiting_) % kMostPending] = {time_ + physics_.delayTicks * 1e-3, force};
    ++waiting_;
}

void SimulatedArm::start(Vec3 place, Vec3 velocity) {
    axes_ = {ArmAxis{place.x, velocity.x}, ArmAxis{place.y, velocity.y}, ArmAxis{place.z, velocity.z}};
}

double SimulatedArm::kineticEnergy() const { return physics_.mass / 2 * dot(velocity(), velocity()); }

void SimulatedArm::advanceTo(double time, Vec3 targetVelocity) {
    const Vec3 force = acting_ + load_;
    const double span = time - time_;
    axes_[0].advance(body_, force.x, {target_.place.x, targetVelocity.x}, span);
    axes_[1].advance(body_, force.y, {target_.place.y, targetVelocity.y}, span);
    axes_[2].advance(body_, force.z, {target_.place.z, targetVelocity.z}, span);
    for (ArmAxis& axis : axes_) {
        if (std::abs(axis.place) > physics_.reach) {  // an end stop stops the arm at once
            axis = {std::copysign(physics_.reach, axis.place), 0};
        }
    }
    time_ = time;
}

}  // namespace haptic_bridge
