// SPDX-License-Identifier: Apache-2.0
#include "render_node/tool/reach.hpp"

#include <algorithm>
#include <cmath>

namespace render_node {
namespace {

// The values of shaders/light.glsl [radius], with a hundredth more for rounding of GL's floats.
constexpr double kSkyReach = 1.8 * 1.01;
constexpr double kShadowLength = 20.0 * 1.01;
constexpr double kPenumbra = 0.08 + 0.01, kPenumbraGrowth = 0.07;
constexpr double kBegins = 1.2;   // higher above the centre there is no shadow
constexpr double kLowSun = 0.25;  // least z of `sun_`; below it the shadow is too long to be bounded at two heights

bool overlap(const shapes::Box& a, const shapes::Box& b) {
    return glm::all(glm::lessThanEqual(a.low, b.high)) && glm::all(glm::lessThanEqual(b.low, a.high));
}

}  // namespace

double ToolReach::halfWidth(double along) const { return (1 + kPenumbra) * radius_ + kPenumbraGrowth * along; }

shapes::Box ToolReach::shadowAt(double along) const {
    const glm::dvec3 middle = centre_ - along * sun_;
    return {middle - halfWidth(along), middle + halfWidth(along)};
}

bool ToolReach::meets(const shapes::Box& box) const {
    const glm::dvec3 apart = centre_ - glm::clamp(centre_, box.low, box.high);
    const double reach = kSkyReach * radius_;
    if (glm::dot(apart, apart) <= reach * reach) {
        return true;
    }
    const std::array<shapes::Box, 2> shadow = shadowBetween(box.low.z, box.high.z);
    return overlap(box, around(shadow.front(), shadow.back()));
}

shapes::Box ToolReach::closeBy(double lowest, double highest) const {
    const double reach = kSkyReach * radius_;
    // If the tool is high above everything, the sphere in which it takes skylight reaches only little of the scene, or
    // misses it.
    const double above = std::max(0.0, centre_.z - highest);
    const double wide = std::sqrt(std::max(0.0, reach * reach - above * above));
    return {{centre_.x - wide, centre_.y - wide, std::max(centre_.z - reach, lowest)},
            {centre_.x + wide, centre_.y + wide, std::min(centre_.z + reach, highest)}};
}

// The cone of the shadow meets a height in an ellipse, elongated away from the sun. Every line within the cone passes
// through the ellipses at both ends.
shapes::Box ToolReach::shadowAtHeight(double height) const {
    const double slant = std::hypot(sun_.x, sun_.y) / sun_.z;
    const double along = (centre_.z - height) / sun_.z;
    const double half = std::max(halfWidth(0), halfWidth(along) / (1 - kPenumbraGrowth * slant));
    const glm::dvec3 middle = centre_ - along * sun_;
    const glm::dvec3 wide(half * std::hypot(1.0, sun_.x / sun_.z), half * std::hypot(1.0, sun_.y / sun_.z), 0);
    return {middle - wide, middle + wide};
}

std::array<shapes::Box, 2> ToolReach::shadowBetween(double lowest, double highest) const {
    const double longest = kShadowLength * radius_;
    if (sun_.z < kLowSun) {
        return {shadowAt(0), shadowAt(longest)};
    }
    const double top = std::min(highest, centre_.z + kBegins * radius_);
    const double end = centre_.z - longest * sun_.z - halfWidth(longest);
    return {shadowAtHeight(top), shadowAtHeight(std::min(top, std::max(lowest, end)))};
}

}  // namespace render_node
