// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "walls/wall.hpp"

namespace walls {

/// View of one eye through one screen: an off-axis frustum and its matrices.
///
/// The matrices are GLM's: columns, and OpenGL's clip space with z in [-1, 1], in double precision. Multiply them in
/// double precision and convert the product. Otherwise the tiles of a large wall may differ by a pixel at their
/// borders.
struct View {
    double left = 0, right = 0, bottom = 0, top = 0;  // [m], edges of the screen as seen on the near plane
    double near = 0, far = 0;                         // [m], distance from the eye along the screen's normal
    glm::dvec3 eye{0};                                // [m], room
    glm::dmat4 projection{1};                         // eye space to clip space
    glm::dmat4 view{1};                               // room to eye space; the axes are those of the screen
    glm::dmat4 viewProjection{1};                     // room to clip space
};

/// Returns the position of an eye in the room [m].
[[nodiscard]] glm::dvec3 eyePosition(const Viewer& viewer, Eye eye);

/// Returns the generalised perspective projection (Kooima 2009). The corners of the screen are at the corners of the
/// picture wherever the eye is, if it is in front of the screen. loadWall() checks this for a fixed viewer.
///
/// Throws std::invalid_argument if the eye is not in front of the screen, or unless 0 < near < far.
[[nodiscard]] View viewOf(const Screen& screen, glm::dvec3 eye, double near, double far);

/// Returns the view through a tile of a wall whose viewer does not move.
[[nodiscard]] View viewOf(const Wall& wall, const Tile& tile, Eye eye);

/// Returns the matrix from the scene to the room, a similarity without mirroring.
///
/// Scene axes are x east, y north, z up, from the south-west corner of the field. All arguments are in scene units. The
/// centre of the field at referenceZ maps to stage.centre, and the field's longer side to stage.width metres. Without
/// tilt the field is level: up stays up, and north points away from the viewer.
///
/// Throws std::invalid_argument unless fieldWidth and fieldHeight are positive.
[[nodiscard]] glm::dmat4 stageToRoom(const Stage& stage, double fieldWidth, double fieldHeight, double referenceZ);

}  // namespace walls
