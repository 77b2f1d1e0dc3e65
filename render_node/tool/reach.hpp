// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "render_node/surface/frustum.hpp"

namespace render_node {

/// Where a tool takes light from what is around it: close by from the sky, and along its shadow from the sun. Bounds
/// of what shaders/light.glsl computes; beyond, that is exactly nothing.
class ToolReach {
public:
    /// All in scene units; `sun` points towards it, of length 1. The radius is positive.
    ToolReach(const glm::dvec3& centre, double radius, const glm::dvec3& sun)
        : centre_(centre), radius_(radius), sun_(sun) {}

    /// Whether it may change the look of anything within a box.
    [[nodiscard]] bool meets(const Box& box) const;
    /// What it takes skylight from, where nothing lies outside these heights.
    [[nodiscard]] Box closeBy(double lowest, double highest) const;
    /// Its shadow between two heights: within the convex hull of the corners of two boxes, the last the lower one.
    [[nodiscard]] std::array<Box, 2> shadowBetween(double lowest, double highest) const;

private:
    // Half of its width so far behind the tool [scene unit].
    [[nodiscard]] double halfWidth(double along) const;
    [[nodiscard]] Box shadowAt(double along) const;
    [[nodiscard]] Box shadowAtHeight(double height) const;  // around its ellipse there

    glm::dvec3 centre_;
    double radius_;
    glm::dvec3 sun_;
};

}  // namespace render_node
