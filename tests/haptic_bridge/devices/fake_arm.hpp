// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "haptic_bridge/hand/arm.hpp"

namespace test {

/// An arm at a place that the test sets. It remembers the force that it is pushed with.
class FakeArm : public haptic_bridge::Arm {
public:
    struct State {
        haptic_bridge::ArmReading reading;
        sand::force::Vec3 pushed;
    };
    explicit FakeArm(State& state) : state_(state) {
        physics_.name = "fake";
        physics_.mass = 0.05;
        physics_.damping = 0.5;
        physics_.friction = physics_.resolution = 0;
        physics_.maxForce = 3.3;
        physics_.reach = 0.1;
        physics_.maxStiffness = std::numeric_limits<double>::infinity();
        physics_.delayTicks = 0;
    }
    [[nodiscard]] const haptic_bridge::ArmPhysics& physics() const override { return physics_; }
    [[nodiscard]] haptic_bridge::ArmReading read(double) override { return state_.reading; }
    void push(sand::force::Vec3 force) override { state_.pushed = force; }

private:
    State& state_;
    haptic_bridge::ArmPhysics physics_;
};

}  // namespace test
