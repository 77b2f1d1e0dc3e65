// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

/// Pose of the viewer's head. No MPI, no GL, no blocking.
///
/// The room is defined in walls/wall.hpp: right-handed, in metres, x to the viewer's right, y up, z towards the viewer.
namespace tracking {

/// Largest distance of a head [m]. A larger number is an error of the tracker or of its units.
inline constexpr double kFarthest = 100;

/// Place and direction of the viewer's eyes in the room.
struct Pose {
    glm::dvec3 position{0};     // [m], the midpoint of the eyes
    glm::dvec3 right{1, 0, 0};  // unit vector from the left eye to the right one
    friend bool operator==(const Pose&, const Pose&) = default;
};

/// Measurement of a tracker, in the tracker's own axes.
struct Measured {
    glm::dvec3 position{0};    // [m]
    glm::dmat3 rotation{1.0};  // the head's axes (right, up, backwards) in the tracker's axes; the unit matrix if the
                               // head is not turned
};

/// Returns the turn by three angles [degree]: roll about z, then pitch about x, then yaw about y. Each angle is
/// counter-clockwise as seen against its axis. For a head that looks along -z, yaw turns it to its left, pitch up, and
/// roll tilts it to its left.
[[nodiscard]] glm::dmat3 rotationOf(double yaw, double pitch, double roll);
/// Returns whether the numbers are finite and within kFarthest, and the rotation is a rotation within one part in a
/// hundred.
[[nodiscard]] bool plausible(const Measured& measured);

}  // namespace tracking
