// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "haptic_bridge/hand/arm.hpp"

namespace haptic_bridge {

/// One number of ArmPhysics, with its bounds. The limits of the forces are computed from these numbers.
struct ArmNumber {
    static constexpr double kInfinite = std::numeric_limits<double>::infinity();
    static constexpr double kLargestFinite = std::numeric_limits<double>::max();

    std::string_view name;       // of the member of ArmPhysics
    std::string_view key;        // of a simulated arm's SPEC; empty for a number that a SPEC cannot change
    std::string_view unit;       // in messages
    double ArmPhysics::*member;  // null for delayTicks, which is an int
    double lowest;
    bool lowestIsOut;  // whether the number must be more than `lowest`
    double highest;

    [[nodiscard]] double of(const ArmPhysics& physics) const { return member ? physics.*member : physics.delayTicks; }
    /// Returns whether a driver left the number out.
    [[nodiscard]] bool isLeftOut(const ArmPhysics& physics) const;
    [[nodiscard]] bool allows(double number) const {
        return (lowestIsOut ? number > lowest : number >= lowest) && number <= highest;  // false for NaN
    }
    /// Returns what is allowed, in words: "more than 0 and at most 100 N s/m".
    [[nodiscard]] std::string bounds() const;
};

/// All numbers of ArmPhysics.
inline constexpr std::array<ArmNumber, 8> kArmNumbers{
    {{"mass", "mass", "kg", &ArmPhysics::mass, 0.005, false, 10},
     {"damping", "damping", "N s/m", &ArmPhysics::damping, 0, true, 100},
     {"friction", "friction", "N", &ArmPhysics::friction, 0, false, ArmNumber::kLargestFinite},
     {"resolution", "resolution", "m", &ArmPhysics::resolution, 0, false, ArmNumber::kLargestFinite},
     {"maxForce", "max_force", "N", &ArmPhysics::maxForce, 0, true, 200},
     {"reach", "", "m", &ArmPhysics::reach, 0.005, false, 2},
     {"maxStiffness", "stiffness", "N/m", &ArmPhysics::maxStiffness, 0, true, ArmNumber::kInfinite},
     {"delayTicks", "delay", "ticks", nullptr, 0, false, 15}}};

/// Returns a complaint about the first number out of its bounds, or nullopt if all are allowed. It says what `giver`
/// must give: "damping is 0; a driver must give more than 0 and at most 100 N s/m".
[[nodiscard]] std::optional<std::string> complaintAbout(const ArmPhysics& physics, std::string_view giver);

}  // namespace haptic_bridge
