// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "walls/wall.hpp"

namespace walls {

/// Place of the sand in front of a viewer who looks at it from another side, from nearer, or at another part of it.
struct Orbit {
    static constexpr double kLowest = 5, kHighest = 85;  // [deg], limits of the tilt of the stage

    double turnDegrees = 0;  // about the sand's vertical, counter-clockwise seen from above
    double tiltDegrees = 0;  // added to the tilt of the stage
    double zoom = 1;         // factor on the size of the sand in the room
    // [scene unit] from the centre of the field at its reference height to the place at stage.centre. All turns are
    // about this place.
    glm::dvec3 aim{0};

    /// Returns this orbit after a drag of the view [side of the window], right and down. The sum of both tilts stays
    /// within its limits, or where it was if the wall file's own tilt is outside of them.
    [[nodiscard]] Orbit dragged(const Stage& stage, double right, double down) const;
    /// Returns the six numbers "ZOOM,TURN,TILT,EAST,NORTH,UP", from which parse() makes an equal orbit.
    [[nodiscard]] std::string text() const;
    /// Throws base::InputError, which begins with `what`, if `text` has other than six finite numbers, or a zoom that
    /// is not positive.
    [[nodiscard]] static Orbit parse(const std::string& text, const std::string& what);
    friend bool operator==(const Orbit&, const Orbit&) = default;
};

/// Returns stageToRoom() with the sand placed by `orbit`. Throws as stageToRoom() does.
[[nodiscard]] glm::dmat4 stageToRoom(const Stage& stage, double fieldWidth, double fieldHeight, double referenceZ,
                                     const Orbit& orbit);

/// Returns whether viewers may turn the sand of this wall: it is a desktop. All screens lie in one plane, show one
/// picture for both eyes, and no tracker moves the viewer.
[[nodiscard]] bool isDesktop(const Wall& wall);

}  // namespace walls
