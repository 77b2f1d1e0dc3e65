// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "shapes/model/box.hpp"
#include "shapes/tool/drawn_tool.hpp"
#include "shapes/tool/light.hpp"

namespace render_node {

/// Bounds of the space in which a tool takes light away. Close to the tool it takes light from the sky. Along its
/// shadow it takes light from the sun.
///
/// The class bounds the values that shaders/light.glsl computes. Outside the bounds those values are exactly 0.
class ToolReach {
public:
    /// All lengths are in scene units. `sun` points towards the sun and has length 1. The radius is positive.
    ToolReach(const glm::dvec3& centre, double radius, const glm::dvec3& sun)
        : centre_(centre), radius_(radius), sun_(sun) {}
    ToolReach(const shapes::DrawnTool& tool, const glm::dvec3& sun) : ToolReach(shapes::ToolLight(tool), sun) {}

    /// Returns whether the tool may change the look of anything within a box.
    [[nodiscard]] bool meets(const shapes::Box& box) const;
    /// Returns the box in which the tool takes skylight away. All objects are between these heights.
    [[nodiscard]] shapes::Box closeBy(double lowest, double highest) const;
    /// Returns two boxes. The convex hull of their corners contains the shadow between two heights. The second box is
    /// the lower one.
    [[nodiscard]] std::array<shapes::Box, 2> shadowBetween(double lowest, double highest) const;

private:
    ToolReach(const shapes::ToolLight& light, const glm::dvec3& sun) : ToolReach(light.centre, light.radius, sun) {}
    // Returns half of the shadow's width at the distance `along` behind the tool [scene unit].
    [[nodiscard]] double halfWidth(double along) const;
    [[nodiscard]] shapes::Box shadowAt(double along) const;
    [[nodiscard]] shapes::Box shadowAtHeight(double height) const;  // around the ellipse of the shadow at this height

    glm::dvec3 centre_;
    double radius_;
    glm::dvec3 sun_;
};

}  // namespace render_node
