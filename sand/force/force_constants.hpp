// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "base/field_forms.hpp"

namespace sand {

/// The law that the hand feels: `repulse` of Dorjgotov et al. 2007, `controlPoints` of Purchart et al. 2012.
enum class ForceLaw : std::uint8_t { repulse, controlPoints };
constexpr auto valuesOf(ForceLaw) {
    return std::array{base::Named{ForceLaw::repulse, "repulse"},
                      base::Named{ForceLaw::controlPoints, "control_points"}};
}
/// Source of the force between two steps of the sand; see sand/force/force_model.hpp.
enum class Between : std::uint8_t { local, hold, interpolate };
constexpr auto valuesOf(Between) {
    return std::array{base::Named{Between::local, "local"}, base::Named{Between::hold, "hold"},
                      base::Named{Between::interpolate, "interpolate"}};
}
/// The part of the velocity that friction acts against. Dorjgotov et al. 2007 calls it vertical and describes a drag.
enum class FrictionDirection : std::uint8_t { tangential, full, vertical };
constexpr auto valuesOf(FrictionDirection) {
    return std::array{base::Named{FrictionDirection::tangential, "tangential"},
                      base::Named{FrictionDirection::full, "full"},
                      base::Named{FrictionDirection::vertical, "vertical"}};
}

/// Constants of both force laws (docs/forces.md). Forces are not part of the sand's state, so that no digest contains
/// these constants.
struct ForceConstants {
    // Dorjgotov et al. 2007.
    double stiffness = 1000;     // k_s [N]
    double depthExponent = 0.5;  // k_c [1/scene unit]
    double friction = 10;        // k_f [frame/scene unit]; a frame is 1/60 s
    double frictionArea = 1;     // k_a [area of the sphere]; the printed k_f holds with 1
    FrictionDirection frictionDirection = FrictionDirection::tangential;
    // Purchart et al. 2012; lengths are in unitLength.
    double maxForce = 10;            // F_M [N]
    double tolerance = 1e-3;         // z_tol [unitLength]
    double unitLength = 1;           // [scene unit]; a scene file's default is the longer side of its field
    double frictionCoefficient = 0;  // mu [1]; 0: friction does not depend on the speed
    double frictionSpeed = 0.5;      // [scene unit/s], at which that friction is mu times the normal force
    // Both laws.
    ForceLaw law = ForceLaw::repulse;
    bool literal = false;  // whether formulas are computed as printed, with their jumps; for comparison
    Between between = Between::local;
    double validity = 0.5;       // [tool reach], distance over which the local model is valid
    double recoveryTime = 0.05;  // time constant with which a new local model takes over [s]

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit);
    friend bool operator==(const ForceConstants&, const ForceConstants&) = default;
};

/// A number of ForceConstants that has a key in [force] of a scene file.
struct ForceKey {
    const char* name;
    double ForceConstants::*constant;
    double lowest, highest;
};
[[nodiscard]] std::span<const ForceKey> forceKeys();

template <class Self, class Visit>
void ForceConstants::fields(Self& it, Visit& visit) {
    for (const ForceKey& key : forceKeys()) {
        visit(key.name, base::limited(it.*key.constant, key.lowest, key.highest));
    }
    visit("law", it.law);
    visit("between", it.between);
    visit("friction_direction", it.frictionDirection);
    visit("literal", it.literal);
}

}  // namespace sand
