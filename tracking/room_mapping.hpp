// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string_view>

#include "tracking/pose.hpp"

namespace tracking {

/// How a tracker stands in the room: its axes, its origin, and where the eyes are beside what it tracks.
struct RoomMapping {
    glm::dvec3 origin{0};  // [m], of the tracker, in the room
    glm::dmat3 axes{1.0};  // tracker to room: each axis along one of the room's, to either side
    glm::dvec3 eyes{0};    // [m], from the tracked point to between the eyes; the head's right, up and backwards

    [[nodiscard]] Pose pose(const Measured& measured) const;
};

/// "x,z,-y": which axis of the tracker runs along the room's x, y and z, reversed with '-'. Nothing when it is not
/// that.
[[nodiscard]] std::optional<glm::dmat3> axesOf(std::string_view text);
/// "x,y,z" in metres. Nothing when it is not three numbers.
[[nodiscard]] std::optional<glm::dvec3> pointOf(std::string_view text);

}  // namespace tracking
