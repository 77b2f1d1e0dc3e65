// SPDX-License-Identifier: Apache-2.0
#pragma once

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
        physics_.reach = 0.1;
    }
    [[nodiscard]] const haptic_bridge::ArmPhysics& physics() const override { return physics_; }
    [[nodiscard]] haptic_bridge::ArmReading read(double) override { return state_.reading; }
    void push(sand::force::Vec3 force) override { state_.pushed = force; }

private:
    State& state_;
    haptic_bridge::ArmPhysics physics_;
};

}  // namespace test
