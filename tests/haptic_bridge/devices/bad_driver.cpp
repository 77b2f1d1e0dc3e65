// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cfenv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

#include "haptic_bridge/devices/driver.hpp"

namespace {

using haptic_bridge::ArmReading;
using sand::force::Vec3;

/// A faulty arm. It presses into the sand. With "stops:FILE", "nan:FILE" and "jumps:FILE" it has this fault as soon as
/// the file exists. With "press:FILE" it keeps pressing, and its destructor writes the greatest force that it was
/// pushed with. With "rough" its constructor leaves another rounding behind. With "number:NAME=VALUE:FILE" a number of
/// its physics has this value, or its default for the value "forgotten". Each push then adds a line to the file.
class BadArm : public haptic_bridge::Arm {
public:
    explicit BadArm(std::string what) : what_(std::move(what)) {
        if (what_ == "throws") {
            throw std::runtime_error("the device on USB 3 is taken");
        }
        if (what_ == "throws 7") {
            throw 7;
        }
        if (what_ == "rough") {
            std::fesetround(FE_UPWARD);  // as a library of fast-math that the driver loads when it opens its device
        }
        physics_.name = "bad";
        if (what_.starts_with("number:")) {
            takeNumber();
        }
        setOthers();
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
        if (faulty("stops:")) {
            reading.present = false;
        } else if (faulty("nan:")) {
            reading.place.y = std::numeric_limits<double>::quiet_NaN();
        } else if (faulty("jumps:") && (++reads_ / 10) % 2 == 0) {
            reading.place.x += 1;
        }
        return reading;
    }
    void push(Vec3 force) override {
        largest_ = std::max(largest_, norm(force));
        if (!pushed_.empty()) {
            std::ofstream(pushed_, std::ios::app) << norm(force) << '\n';
        }
    }

private:
    /// Returns whether the arm has the fault `kind` now.
    [[nodiscard]] bool faulty(const std::string& kind) const {
        return what_.starts_with(kind) && std::filesystem::exists(what_.substr(kind.size()));
    }
    void takeNumber() {
        const auto equals = what_.find('='), colon = what_.find(':', equals);
        name_ = what_.substr(7, equals - 7);
        pushed_ = what_.substr(colon + 1);
        const std::string value = what_.substr(equals + 1, colon - equals - 1);
        if (value == "forgotten") {
            return;
        }
        if (name_ == "delayTicks") {
            physics_.delayTicks = std::stoi(value);
        } else {
            *numbers_.at(name_) = std::strtod(value.c_str(), nullptr);
        }
    }
    /// Sets all numbers but that of the SPEC to those of a Touch with a larger reach.
    void setOthers() {
        for (const auto& [name, value] : std::map<std::string, double>{{"mass", 0.05},
                                                                       {"damping", 0.5},
                                                                       {"friction", 0},
                                                                       {"resolution", 0},
                                                                       {"maxForce", 3.3},
                                                                       {"reach", 0.1},
                                                                       {"maxStiffness", HUGE_VAL}}) {
            if (name != name_) {
                *numbers_.at(name) = value;
            }
        }
        if (name_ != "delayTicks") {
            physics_.delayTicks = 0;
        }
    }

    std::string what_;
    haptic_bridge::ArmPhysics physics_;
    const std::map<std::string, double*> numbers_{{"mass", &physics_.mass},
                                                  {"damping", &physics_.damping},
                                                  {"friction", &physics_.friction},
                                                  {"resolution", &physics_.resolution},
                                                  {"maxForce", &physics_.maxForce},
                                                  {"reach", &physics_.reach},
                                                  {"maxStiffness", &physics_.maxStiffness}};
    std::string name_;    // of the number that `what` sets
    std::string pushed_;  // file of the pushes
    int reads_ = 0;
    double largest_ = 0;
};

}  // namespace

SANDWALL_DRIVER(BadArm)
