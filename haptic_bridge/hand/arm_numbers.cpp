// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/arm_numbers.hpp"

#include <fmt/format.h>

#include <cmath>

namespace haptic_bridge {

bool ArmNumber::isLeftOut(const ArmPhysics& physics) const {
    return member != nullptr ? std::isnan(physics.*member) : physics.delayTicks == ArmPhysics::kNoDelayGiven;
}

std::string ArmNumber::bounds() const {
    const std::string least = lowestIsOut ? fmt::format("more than {}", lowest) : fmt::format("{}", lowest);
    if (highest == kInfinite) {
        return fmt::format("{} {}, or infinity where the maker states none", least, unit);
    }
    if (highest == kLargestFinite) {
        return fmt::format("{} {} or more", least, unit);
    }
    return lowestIsOut ? fmt::format("{} and at most {} {}", least, highest, unit)
                       : fmt::format("{} to {} {}", least, highest, unit);
}

std::optional<std::string> complaintAbout(const ArmPhysics& physics, std::string_view giver) {
    for (const ArmNumber& number : kArmNumbers) {
        if (number.isLeftOut(physics)) {
            return fmt::format("does not state its {}; {} must give {}", number.name, giver, number.bounds());
        }
        if (!number.allows(number.of(physics))) {
            return fmt::format("{} is {}; {} must give {}", number.name, number.of(physics), giver, number.bounds());
        }
    }
    return std::nullopt;
}

}  // namespace haptic_bridge
