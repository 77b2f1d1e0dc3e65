// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "haptic_bridge/hand/arm.hpp"

namespace test {

/// A force that an arm was told to push.
struct Push {
    double time = 0;  // [s], of the reading before
    sand::force::Vec3 force;
};

/// An arm that moves along a path, whatever pushes it, and keeps every force that it was told to push.
class LoggingArm : public haptic_bridge::Arm {
public:
    using Path = std::function<haptic_bridge::ArmReading(double time /* [s] */)>;

    /// `log` gets every push, and must outlive the arm.
    LoggingArm(haptic_bridge::ArmPhysics physics, Path path, std::vector<Push>& log)
        : physics_(std::move(physics)), path_(std::move(path)), log_(log) {}

    [[nodiscard]] const haptic_bridge::ArmPhysics& physics() const override { return physics_; }
    [[nodiscard]] haptic_bridge::ArmReading read(double time) override {
        time_ = time;
        return path_(time);
    }
    void push(sand::force::Vec3 force) override { log_.push_back({time_, force}); }

private:
    haptic_bridge::ArmPhysics physics_;
    Path path_;
    std::vector<Push>& log_;
    double time_ = 0;
};

}  // namespace test
