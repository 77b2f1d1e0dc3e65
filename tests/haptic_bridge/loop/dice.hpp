// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <initializer_list>
#include <limits>
#include <random>

#include "haptic_bridge/loop/guards/force_limits.hpp"

namespace test {

/// Random numbers of a fuzzer, the same with every standard library.
class Dice {
public:
    explicit Dice(unsigned seed) : random_(seed) {}

    [[nodiscard]] double between(double lowest, double highest) { return lowest + (highest - lowest) * part(); }
    /// Returns a number whose logarithm is evenly spread.
    [[nodiscard]] double scaled(double lowest, double highest) { return lowest * std::pow(highest / lowest, part()); }
    [[nodiscard]] bool chance(double share) { return part() < share; }
    [[nodiscard]] int below(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }
    template <class Value>
    [[nodiscard]] Value oneOf(std::initializer_list<Value> values) {
        return values.begin()[below(static_cast<int>(values.size()))];
    }
    /// Returns a number that no honest tick has.
    [[nodiscard]] double odd() {
        using Limits = std::numeric_limits<double>;
        return oneOf({Limits::quiet_NaN(), Limits::quiet_NaN(), Limits::quiet_NaN(), Limits::infinity(),
                      -Limits::infinity(), Limits::max(), Limits::lowest(), Limits::denorm_min(), Limits::min(), -0.0,
                      1e300, -1e10, 1e6, -1e6});
    }
    /// Returns a vector whose size is at most `size`.
    [[nodiscard]] sand::force::Vec3 vector(double size) {
        constexpr double kPart = 0.577;  // 1/√3
        return {kPart * between(-size, size), kPart * between(-size, size), kPart * between(-size, size)};
    }

private:
    [[nodiscard]] double part() { return static_cast<double>(random_()) / 4294967296.0; }

    std::mt19937 random_;
};

/// Returns an arm whose numbers are anywhere within the bounds of haptic_bridge/hand/arm_numbers.hpp. `ordinary`: its
/// forces can be felt.
inline haptic_bridge::ArmPhysics randomArm(Dice& dice, bool ordinary) {
    haptic_bridge::ArmPhysics arm;
    arm.name = "random";
    arm.mass = dice.scaled(0.005, 10);
    arm.damping = dice.scaled(0.05, 100);
    arm.friction = dice.chance(0.5) ? 0 : dice.scaled(1e-3, 10);
    arm.resolution = dice.chance(0.3) ? 0 : dice.scaled(1e-6, 1e-3);
    arm.maxForce = dice.scaled(0.5, 200);
    arm.reach = dice.scaled(0.005, 2);
    arm.maxStiffness = dice.chance(0.3) ? std::numeric_limits<double>::infinity() : dice.scaled(50, 1e5);
    arm.delayTicks = dice.below(16);
    if (!ordinary) {
        double& number = *dice.oneOf({&arm.damping, &arm.friction, &arm.resolution, &arm.maxForce, &arm.maxStiffness});
        const bool mayBeLarge = &number == &arm.friction || &number == &arm.resolution;
        number = mayBeLarge && dice.chance(0.5) ? 1e300 : 1e-300;
    }
    return arm;
}

/// Returns the limits of a random arm, scale and law.
inline haptic_bridge::ForceLimits randomLimits(Dice& dice) {
    haptic_bridge::LawAtRadius law;
    law.stiffness = dice.chance(0.05) ? dice.oneOf({0.0, 1e300}) : dice.scaled(1e-3, 1e9);
    law.drag = dice.scaled(1e-3, 1e6);
    law.push = dice.scaled(1e-3, 1e6);
    const haptic_bridge::StepTiming steps{
        dice.oneOf({sand::Between::local, sand::Between::hold, sand::Between::interpolate}), dice.scaled(1, 240)};
    return haptic_bridge::ForceLimits::of(randomArm(dice, !dice.chance(0.1)), dice.scaled(1e-2, 1e4), law,
                                          dice.between(0, 2), dice.chance(0.5) ? 0 : dice.scaled(1e-6, 1e-3), steps);
}

}  // namespace test
