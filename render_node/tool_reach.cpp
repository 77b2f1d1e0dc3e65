// SPDX-License-Identifier: Apache-2.0
#include "render_node/tool_reach.hpp"

#include <algorithm>
#include <cmath>

namespace render_node {
namespace {

// As in shaders/light.glsl, ball.glsl and stamp.glsl, in radii; a hundredth more, for what GL's floats may round.
constexpr double kSkyReach = 2.5 * 1.01;
constexpr double kShadowLength = 20.0 * 1.01;
constexpr double kPenumbra = 0.08 + 0.01, kPenumbraGrowth = 0.07;
constexpr int kPieces = 6;  // of the shadow, to bound it more closely than by its widest end

bool overlap(const Box& a, const Box& b) {
    return glm::all(glm::lessThanEqual(a.low, b.high)) && glm::all(glm::lessThanEqual(b.low, a.high));
}

}  // namespace

double ToolReach::halfWidth(double along) const { return (1 + kPenumbra) * radius_ + kPenumbraGrowth * along; }

Box ToolReach::shadowAt(double along) const {
    const glm::dvec3 middle = centre_ - along * sun_;
    return {middle - halfWidth(along), middle + halfWidth(along)};
}

bool ToolReach::meets(const Box& box) const {
    if (overlap(box, {centre_ - kSkyReach * radius_, centre_ + kSkyReach * radius_})) {
        return true;
    }
    const double piece = kShadowLength * radius_ / kPieces;
    for (int i = 0; i < kPieces; ++i) {
        if (overlap(box, around(shadowAt(i * piece), shadowAt((i + 1) * piece)))) {
            return true;
        }
    }
    return false;
}

Box ToolReach::closeBy(double lowest, double highest) const {
    const double reach = kSkyReach * radius_;
    // High above everything, its ball of dimmed places meets little of it, or nothing.
    const double above = std::max(0.0, centre_.z - highest);
    const double wide = std::max(1.01 * radius_, std::sqrt(std::max(0.0, reach * reach - above * above)));
    Box box{centre_ - glm::dvec3(wide, wide, reach), centre_ + glm::dvec3(wide, wide, reach)};
    box.low.z = std::min(centre_.z - 1.01 * radius_, std::max(box.low.z, lowest));
    box.high.z = std::max(centre_.z + 1.01 * radius_, std::min(box.high.z, highest));
    return box;
}

std::vector<Box> ToolReach::shadowDownTo(double lowest) const {
    // Until its upper edge is as low: z of the middle and half of its width both change evenly.
    const double drop = std::max(0.0, centre_.z + halfWidth(0) - lowest);
    const double falling = sun_.z - kPenumbraGrowth;
    const double longest = kShadowLength * radius_;
    return {shadowAt(0), shadowAt(falling > 0 ? std::min(longest, drop / falling) : longest)};
}

}  // namespace render_node
