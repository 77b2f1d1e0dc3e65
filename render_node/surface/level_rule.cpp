// SPDX-License-Identifier: Apache-2.0
#include "render_node/surface/level_rule.hpp"

#include <algorithm>
#include <cmath>

namespace render_node {

LevelRule::LevelRule(const glm::dmat4& sceneToClip, glm::ivec2 size, double bound, double pixelsPerQuad)
    : sceneToClip_(sceneToClip), half_(glm::dvec2(size) / 2.0), bound_(bound), pixelsPerQuad_(pixelsPerQuad) {}

/// Returns the largest distance that a point's picture moves when the point moves by one scene unit along an axis: 0 is
/// east, 1 north, 2 up [pixel].
///
/// All tiles of a plane get the same value. Their clip coordinates differ by a scale and by a multiple of w. The number
/// of pixels compensates the scale, and the difference below removes the multiple of w.
double LevelRule::pixelsPerUnit(const shapes::Box& box, int axis) const {
    double nearest = std::numeric_limits<double>::infinity();
    glm::dvec2 most(0);
    const glm::dvec4 unit = sceneToClip_[axis];
    for (const glm::dvec3& corner : shapes::cornersOf(box)) {
        const glm::dvec4 clip = sceneToClip_ * glm::dvec4(corner, 1);
        nearest = std::min(nearest, clip.w);
        most = glm::max(most, glm::abs(glm::dvec2(unit) * clip.w - glm::dvec2(clip) * unit.w));
    }
    return nearest <= 0 ? std::numeric_limits<double>::infinity() : glm::length(half_ * most) / (nearest * nearest);
}

/// The area of a small level quad at a point is a determinant, divided by the third power of w. As in pixelsPerUnit(),
/// all tiles of a plane get the same value.
std::optional<int> LevelRule::levelWhileMoving(const shapes::Box& box, double cell, int coarsest) const {
    const auto flat = [](const glm::dvec4& clip) { return glm::dvec3(clip.x, clip.y, clip.w); };
    const glm::dvec3 normal = glm::cross(flat(sceneToClip_[0]), flat(sceneToClip_[1]));
    double largest = 0;  // [pixel], of a quad of level 0
    for (const glm::dvec3& corner : shapes::cornersOf(box)) {
        const glm::dvec3 at = flat(sceneToClip_ * glm::dvec4(corner, 1));
        if (at.z <= 0) {
            return std::nullopt;
        }
        const double area = std::abs(glm::dot(at, normal)) / (at.z * at.z * at.z) * half_.x * half_.y * cell * cell;
        largest = std::max(largest, area);
    }
    int level = 0;
    while (level < coarsest && std::ldexp(largest, 2 * level) < pixelsPerQuad_) {
        ++level;
    }
    return level;
}

int LevelRule::finest(const shapes::Box& box, double cell, int coarsest) const {
    const double side = cell * std::max(pixelsPerUnit(box, 0), pixelsPerUnit(box, 1));  // [pixel]
    int level = 0;
    while (level < coarsest && std::ldexp(side, level + 1) <= 2 * bound_) {
        ++level;
    }
    return level;
}

int LevelRule::level(const shapes::Box& box, const LevelErrors& errors, int finest, int coarsest) const {
    if (needsEveryCell() || coarsest == 0) {
        return 0;
    }
    const double height = bound_ / pixelsPerUnit(box, 2);
    const double light = bound_ * kLightPerPixel;
    int level = coarsest;
    while (level > finest && (double{errors.height[static_cast<std::size_t>(level)]} > height ||
                              double{errors.light[static_cast<std::size_t>(level)]} > light)) {
        --level;
    }
    return level;
}

}  // namespace render_node
