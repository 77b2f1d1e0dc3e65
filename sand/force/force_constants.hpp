// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "base/byte_stream.hpp"

namespace sand {

/// The law that the hand feels: `repulse` of Dorjgotov et al. 2007, `controlPoints` of Purchart et al. 2012.
enum class ForceLaw : std::uint8_t { repulse, controlPoints };
/// What is felt between two steps of the sand (sand/force/force_model.hpp).
enum class Between : std::uint8_t { local, hold, interpolate };
/// The part of the velocity that friction acts against. Dorjgotov et al. 2007 calls it vertical and describes a drag.
enum class FrictionDirection : std::uint8_t { tangential, full, vertical };

/// Constants of both papers' force laws (docs/forces.md). Forces are no state of the sand: never part of a digest.
struct ForceConstants {
    // Dorjgotov et al. 2007.
    double stiffness = 1000;     // k_s [N]
    double depthExponent = 0.5;  // k_c [1/scene unit]
    double friction = 10;        // k_f [frame/scene unit], a frame being 1/60 s
    double frictionArea = 1;     // k_a [sphere's]: the printed k_f holds with 1
    FrictionDirection frictionDirection = FrictionDirection::tangential;
    // Purchart et al. 2012; lengths are in unitLength.
    double maxForce = 10;            // F_M [N]
    double tolerance = 1e-3;         // z_tol [unitLength]
    double unitLength = 1;           // [scene unit]; a scene file's default is the longer side of its field
    double frictionCoefficient = 0;  // mu [1]; 0: friction does not depend on the speed
    double frictionSpeed = 0.5;      // [scene unit/s], at which that friction is mu times the normal force
    // Both laws.
    ForceLaw law = ForceLaw::repulse;
    bool literal = false;  // as printed, jumps and all; for comparison
    Between between = Between::local;
    double validity = 0.5;       // [tool reach], how far the local model is believed from where it was made
    double recoveryTime = 0.05;  // [s], time constant with which a new local model takes over

    /// What a scene's encoding ends with. The three oldest constants stand elsewhere in it.
    void encodeRest(base::ByteWriter& writer) const;
    /// Throws base::FormatError for numbers that no scene file gives.
    void decodeRest(base::ByteReader& reader);
    friend bool operator==(const ForceConstants&, const ForceConstants&) = default;
};

/// A number of ForceConstants that has a key in [force].
struct ForceKey {
    const char* name;
    double ForceConstants::*constant;
    double lowest, highest;
};
[[nodiscard]] std::span<const ForceKey> forceKeys();

}  // namespace sand
