// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

/// Where the viewer's head is. No MPI, no GL; nothing here blocks.
///
/// The room is that of walls/wall.hpp: right-handed, in metres, x to the viewer's right, y up, z towards the viewer.
namespace tracking {

/// Farther away than this no head is [m]: such a number is a mistake of the tracker or of its units.
inline constexpr double kFarthest = 100;

/// The viewer's eyes in the room.
struct Pose {
    glm::dvec3 position{0};     // [m], the midpoint of the eyes
    glm::dvec3 right{1, 0, 0};  // unit vector from the left eye to the right one
    friend bool operator==(const Pose&, const Pose&) = default;
};

/// What a tracker measures, in its own axes.
struct Measured {
    glm::dvec3 position{0};    // [m]
    glm::dmat3 rotation{1.0};  // the head's axes (right, up, backwards) in the tracker's; unturned: parallel to them
};

/// The turn by three angles [degree], each counter-clockwise as seen against its axis: roll about z, then pitch about
/// x, then yaw about y. For a head that looks along -z: yaw turns it to its left, pitch up, roll tilts it to its left.
[[nodiscard]] glm::dmat3 rotationOf(double yaw, double pitch, double roll);
/// Finite numbers within kFarthest, and a rotation that is one within a part in a hundred.
[[nodiscard]] bool plausible(const Measured& measured);

}  // namespace tracking
