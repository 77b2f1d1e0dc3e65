// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/glm.hpp>

#include "walls/wall.hpp"

namespace render_node {

/// Place in a window: pixels from its top left corner. It may lie outside the window, because a pressed pointer belongs
/// to the window in which it was pressed, also after it has left it.
struct WindowPlace {
    std::size_t output = 0;  // index in tile.outputs
    glm::dvec2 at{0};        // [pixel]
};

/// Returns the point of the room that a place in a window of `tile` shows [m].
///
/// Usually the point lies in the plane of `tile`'s screen, which is extended beyond its edges. The exception is a place
/// in the window of another tile on the same display, if the wall file places both windows. The point is then on that
/// tile's screen. So a stroke continues exactly under the pointer behind a bezel.
[[nodiscard]] glm::dvec3 roomPoint(const walls::Wall& wall, const walls::Tile& tile, const WindowPlace& place);

/// Line of sight from an eye.
struct Ray {
    glm::dvec3 from{0};
    glm::dvec3 along{0, 0, -1};  // need not be a unit vector
};

/// Returns the line from the midpoint of the eyes through a point of the room, in the scene's coordinates and units.
[[nodiscard]] Ray sightRay(glm::dvec3 eye, glm::dvec3 point /* [m] */, const glm::dmat4& sceneToRoom);

}  // namespace render_node
