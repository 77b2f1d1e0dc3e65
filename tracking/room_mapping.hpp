// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string_view>

#include "tracking/pose.hpp"

namespace tracking {

/// Place of a tracker in the room: its axes, its origin, and the offset of the eyes from the tracked point.
struct RoomMapping {
    glm::dvec3 origin{0};  // [m], the tracker's origin in the room
    glm::dmat3 axes{1.0};  // from the tracker to the room; each axis is along one of the room's, in either direction
    // [m], from the tracked point to the midpoint of the eyes, along the head's right, up and backwards.
    glm::dvec3 eyes{0};

    [[nodiscard]] Pose pose(const Measured& measured) const;
};

/// Reads axes such as "x,z,-y": the tracker's axes that run along the room's x, y and z, reversed with '-'. Returns
/// nullopt for any other text.
[[nodiscard]] std::optional<glm::dmat3> axesOf(std::string_view text);
/// Reads "x,y,z" in metres. Returns nullopt if the text is not three numbers.
[[nodiscard]] std::optional<glm::dvec3> pointOf(std::string_view text);

}  // namespace tracking
