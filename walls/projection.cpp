// SPDX-License-Identifier: Apache-2.0
#include "walls/projection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <stdexcept>

namespace walls {

glm::dvec3 eyePosition(const Viewer& viewer, Eye eye) {
    const double side = eye == Eye::left ? -0.5 : eye == Eye::right ? 0.5 : 0.0;
    return viewer.eye + viewer.right * (side * viewer.eyeSeparation);
}

View viewOf(const Screen& screen, glm::dvec3 eye, double near, double far) {
    const double distance = screen.distanceTo(eye);
    if (!(distance > 0) || !(near > 0) || !(far > near)) {
        throw std::invalid_argument(
            fmt::format("no view: eye {} m before the screen, near {} m, far {} m", distance, near, far));
    }
    const glm::dvec3 right = screen.right();
    const glm::dvec3 up = screen.up();
    const glm::dvec3 normal = screen.normal();
    const double toNear = near / distance;
    View result;
    result.left = glm::dot(right, screen.lowerLeft - eye) * toNear;
    result.right = glm::dot(right, screen.lowerRight - eye) * toNear;
    result.bottom = glm::dot(up, screen.lowerLeft - eye) * toNear;
    result.top = glm::dot(up, screen.upperLeft - eye) * toNear;
    result.near = near;
    result.far = far;
    result.eye = eye;
    result.projection = glm::frustumRH_NO(result.left, result.right, result.bottom, result.top, near, far);
    // The rows are the screen's axes. In the resulting frame the screen is upright, and the eye looks along -z.
    const glm::dmat3 axes = glm::transpose(glm::dmat3(right, up, normal));
    result.view = glm::translate(glm::dmat4(axes), -eye);
    result.viewProjection = result.projection * result.view;
    return result;
}

View viewOf(const Wall& wall, const Tile& tile, Eye eye) {
    return viewOf(tile.screen, eyePosition(wall.viewer, eye), wall.clip.near, wall.clip.far);
}

glm::dmat4 stageToRoom(const Stage& stage, double fieldWidth, double fieldHeight, double referenceZ) {
    if (!(fieldWidth > 0) || !(fieldHeight > 0)) {
        throw std::invalid_argument(fmt::format("a field of {} x {} cannot be staged", fieldWidth, fieldHeight));
    }
    // The columns are the directions of the scene's east, north and up in the room.
    const glm::dmat3 flat({1, 0, 0}, {0, 0, -1}, {0, 1, 0});
    glm::dmat4 result = glm::translate(glm::dmat4(1), stage.centre);
    result = glm::rotate(result, glm::radians(stage.turnDegrees), glm::dvec3(0, 1, 0));
    result = glm::rotate(result, glm::radians(stage.tiltDegrees), glm::dvec3(1, 0, 0));
    result = result * glm::dmat4(flat);
    result = glm::scale(result, glm::dvec3(stage.width / std::max(fieldWidth, fieldHeight)));
    return glm::translate(result, {-fieldWidth / 2, -fieldHeight / 2, -referenceZ});
}

}  // namespace walls
