// SPDX-License-Identifier: Apache-2.0
#include "sand/force/force_constants.hpp"

#include <array>
#include <limits>

namespace sand {
namespace {

constexpr double kTiny = 1e-9, kHuge = 1e9;

// The first three keys are the oldest. The encoding of a scene keeps them apart.
constexpr std::size_t kOldest = 3;
constexpr std::array kConstantKeys{
    ForceKey{"stiffness", &ForceConstants::stiffness, 0, kHuge},
    ForceKey{"depth_exponent", &ForceConstants::depthExponent, 0, 1e6},
    ForceKey{"friction", &ForceConstants::friction, 0, kHuge},
    ForceKey{"friction_area", &ForceConstants::frictionArea, 0, 1e6},
    ForceKey{"max_force", &ForceConstants::maxForce, 0, 1e6},
    ForceKey{"tolerance", &ForceConstants::tolerance, 0, 1},
    ForceKey{"unit_length", &ForceConstants::unitLength, std::numeric_limits<double>::min(),
             std::numeric_limits<double>::max()},
    ForceKey{"friction_coefficient", &ForceConstants::frictionCoefficient, 0, 1e3},
    ForceKey{"friction_speed", &ForceConstants::frictionSpeed, kTiny, kHuge},
    ForceKey{"validity", &ForceConstants::validity, 0, 2},
    ForceKey{"recovery_time", &ForceConstants::recoveryTime, 0, 10},
};

template <class Choice>
Choice decodeChoice(base::ByteReader& reader, int choices) {
    const auto value = reader.get<std::uint8_t>();
    if (value >= choices) {
        throw base::FormatError("a scene with an unknown force law");
    }
    return static_cast<Choice>(value);
}

}  // namespace

std::span<const ForceKey> forceKeys() { return kConstantKeys; }

void ForceConstants::encodeRest(base::ByteWriter& writer) const {
    for (std::size_t i = kOldest; i < kConstantKeys.size(); ++i) {
        writer.put(this->*kConstantKeys.at(i).constant);
    }
    writer.put(static_cast<std::uint8_t>(law));
    writer.put(static_cast<std::uint8_t>(between));
    writer.put(static_cast<std::uint8_t>(frictionDirection));
    writer.put(static_cast<std::uint8_t>(literal ? 1 : 0));
}

void ForceConstants::decodeRest(base::ByteReader& reader) {
    for (std::size_t i = kOldest; i < kConstantKeys.size(); ++i) {
        const ForceKey& key = kConstantKeys.at(i);
        const double value = this->*key.constant = reader.get<double>();
        if (!(value >= key.lowest && value <= key.highest)) {
            throw base::FormatError("a scene with a force constant out of range");
        }
    }
    law = decodeChoice<ForceLaw>(reader, 2);
    between = decodeChoice<Between>(reader, 3);
    frictionDirection = decodeChoice<FrictionDirection>(reader, 3);
    literal = decodeChoice<int>(reader, 2) != 0;
}

}  // namespace sand
