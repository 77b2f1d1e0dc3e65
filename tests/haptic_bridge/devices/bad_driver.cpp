// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cfenv>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>

#include "haptic_bridge/devices/driver.hpp"

namespace {

using haptic_bridge::ArmReading;
using sand::force::Vec3;

/// A faulty arm. It presses into the sand, and after half a second has the fault `what`. With "press:FILE" it keeps
/// pressing. With "rough" its constructor leaves another rounding behind. Its destructor writes the greatest force that
/// it was pushed with.
class BadArm : public haptic_bridge::Arm {
public:
    explicit BadArm(std::string what) : what_(std::move(what)) {
        if (what_ == "throws") {
            throw std::runtime_error("the device on USB 3 is taken");
        }
        if (what_ == "rough") {
            std::fesetround(FE_UPWARD);  // as a library of fast-math that the driver loads when it opens its device
        }
        physics_.name = "bad";
        physics_.reach = 0.1;
    }
    ~BadArm() override {
        if (what_.starts_with("press:")) {
            std::ofstream(what_.substr(6)) << largest_ << '\n';
        }
    }
    [[nodiscard]] const haptic_bridge::ArmPhysics& physics() const override { return physics_; }
    [[nodiscard]] ArmReading read(double time) override {
        ArmReading reading;
        reading.place = {0.02 * std::cos(time), 0.02 * std::sin(time), -0.002};
        const bool bad = time > 0.5;
        if (bad && what_ == "stops") {
            reading.present = false;
        } else if (bad && what_ == "nan") {
            reading.place.y = std::numeric_limits<double>::quiet_NaN();
        } else if (bad && what_ == "jumps" && (++reads_ / 10) % 2 == 0) {
            reading.place.x += 1;
        }
        return reading;
    }
    void push(Vec3 force) override { largest_ = std::max(largest_, norm(force)); }

private:
    std::string what_;
    haptic_bridge::ArmPhysics physics_;
    int reads_ = 0;
    double largest_ = 0;
};

}  // namespace

SANDWALL_DRIVER(BadArm)
