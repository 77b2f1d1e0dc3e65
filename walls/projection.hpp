// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "walls/wall.hpp"

namespace walls {

/// One eye's view through one screen: an off-axis frustum and the matrices made from it.
///
/// Matrices are GLM's (columns, OpenGL's clip space with z in [-1, 1]), in double precision: multiply in double and
/// convert the product, or the tiles of a large wall part by a pixel.
struct View {
    double left = 0, right = 0, bottom = 0, top = 0;  // [m], edges of the screen as seen on the near plane
    double near = 0, far = 0;                         // [m], from the eye along the screen's normal
    glm::dvec3 eye{0};                                // [m], room
    glm::dmat4 projection{1};                         // eye space to clip space
    glm::dmat4 view{1};                               // room to eye space, axes along the screen's
    glm::dmat4 viewProjection{1};                     // room to clip space
};

/// Where an eye is [m, room].
[[nodiscard]] glm::dvec3 eyePosition(const Viewer& viewer, Eye eye);

/// The generalised perspective projection (Kooima 2009): the corners of the screen come out at the corners of the
/// picture wherever the eye is, as long as it is in front; loadWall sees to that for a fixed viewer.
/// Throws std::invalid_argument when the eye is not in front of the screen or not 0 < near < far.
[[nodiscard]] View viewOf(const Screen& screen, glm::dvec3 eye, double near, double far);

/// The same for a tile of a wall with a viewer that does not move.
[[nodiscard]] View viewOf(const Wall& wall, const Tile& tile, Eye eye);

/// Scene to room, a similarity without mirroring.
///
/// Scene axes are x east, y north, z up from the south-west corner of the field, all arguments in scene units. The
/// centre of the field at referenceZ goes to stage.centre, the longer side becomes stage.width metres. Untilted, the
/// field lies flat: up stays up, north points away from the viewer.
/// Throws std::invalid_argument unless fieldWidth and fieldHeight are positive.
[[nodiscard]] glm::dmat4 stageToRoom(const Stage& stage, double fieldWidth, double fieldHeight, double referenceZ);

}  // namespace walls
