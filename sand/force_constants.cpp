// SPDX-License-Identifier: Apache-2.0
#include "sand/force_constants.hpp"

#include <array>

namespace sand {
namespace {

struct Key {
    const char* name;
    double ForceConstants::*constant;
    host::Range range;
};

constexpr double kTiny = 1e-9, kHuge = 1e9;

// The first three are the oldest, which a scene's encoding keeps apart.
constexpr std::size_t kOldest = 3;
constexpr std::array kConstantKeys{
    Key{"stiffness", &ForceConstants::stiffness, {0, kHuge}},
    Key{"depth_exponent", &ForceConstants::depthExponent, {0, 1e6}},
    Key{"friction", &ForceConstants::friction, {0, kHuge}},
    Key{"friction_area", &ForceConstants::frictionArea, {0, 1e6}},
    Key{"max_force", &ForceConstants::maxForce, {0, 1e6}},
    Key{"tolerance", &ForceConstants::tolerance, {0, 1}},
    Key{"unit_length", &ForceConstants::unitLength, host::kPositive},
    Key{"friction_coefficient", &ForceConstants::frictionCoefficient, {0, 1e3}},
    Key{"friction_speed", &ForceConstants::frictionSpeed, {kTiny, kHuge}},
    Key{"validity", &ForceConstants::validity, {0, 2}},
    Key{"recovery_time", &ForceConstants::recoveryTime, {0, 10}},
};

template <class Choice>
Choice decodeChoice(base::ByteReader& reader, int choices) {
    const auto value = reader.get<std::uint8_t>();
    if (value >= choices) {
        throw base::FormatError("a scene with a force law that nobody knows");
    }
    return static_cast<Choice>(value);
}

}  // namespace

ForceConstants ForceConstants::read(const host::TomlTable& table, double side) {
    ForceConstants result;
    result.unitLength = side;
    for (const Key& key : kConstantKeys) {
        result.*key.constant = table.numberOr(key.name, result.*key.constant, key.range);
    }
    result.law = static_cast<ForceLaw>(table.choiceOr("law", {"repulse", "control_points"}, 0));
    result.between = static_cast<Between>(table.choiceOr("between", {"local", "hold", "interpolate"}, 0));
    result.literal = table.flagOr("literal", false);
    result.frictionDirection =
        static_cast<FrictionDirection>(table.choiceOr("friction_direction", {"tangential", "full", "vertical"}, 0));
    if (!result.literal && result.frictionDirection != FrictionDirection::tangential) {
        table.fail("friction_direction",
                   "friction_direction other than tangential is for comparison: set literal = true beside it");
    }
    table.finish();
    return result;
}

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
        const auto [lowest, highest] = kConstantKeys.at(i).range;
        const double value = this->*kConstantKeys.at(i).constant = reader.get<double>();
        if (!(value >= lowest && value <= highest)) {
            throw base::FormatError("a scene with a force constant out of range");
        }
    }
    law = decodeChoice<ForceLaw>(reader, 2);
    between = decodeChoice<Between>(reader, 3);
    frictionDirection = decodeChoice<FrictionDirection>(reader, 3);
    literal = decodeChoice<int>(reader, 2) != 0;
}

}  // namespace sand
