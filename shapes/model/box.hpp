// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <glm/glm.hpp>

namespace shapes {

/// Box along the scene's axes.
struct Box {
    glm::dvec3 low, high;  // [scene unit]
};

/// Returns the smallest box around both.
[[nodiscard]] inline Box around(const Box& a, const Box& b) {
    return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

[[nodiscard]] inline std::array<glm::dvec3, 8> cornersOf(const Box& box) {
    std::array<glm::dvec3, 8> corners;
    for (unsigned corner = 0; corner < 8; ++corner) {
        corners[corner] = {(corner & 1U) != 0 ? box.high.x : box.low.x, (corner & 2U) != 0 ? box.high.y : box.low.y,
                           (corner & 4U) != 0 ? box.high.z : box.low.z};
    }
    return corners;
}

/// Returns whether a box may reach into a camera's frustum. Never returns false for a box that does. Seldom returns
/// true for a box that does not.
[[nodiscard]] inline bool inFrustum(const Box& box, const glm::dmat4& sceneToClip) {
    std::array<int, 6> outside{};
    for (const glm::dvec3& corner : cornersOf(box)) {
        const glm::dvec4 clip = sceneToClip * glm::dvec4(corner, 1);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double along = clip[static_cast<int>(axis)];
            outside[2 * axis] += along < -clip.w ? 1 : 0;
            outside[2 * axis + 1] += along > clip.w ? 1 : 0;
        }
    }
    return std::none_of(outside.begin(), outside.end(), [](int corners) { return corners == 8; });
}

}  // namespace shapes
