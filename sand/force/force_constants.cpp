// SPDX-License-Identifier: Apache-2.0
#include "sand/force/force_constants.hpp"

#include <array>
#include <limits>

namespace sand {
namespace {

constexpr double kTiny = 1e-9, kHuge = 1e9;

// The order in an encoded scene.
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

}  // namespace

std::span<const ForceKey> forceKeys() { return kConstantKeys; }

}  // namespace sand
