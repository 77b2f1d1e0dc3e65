// SPDX-License-Identifier: Apache-2.0
#include "render_node/tool/force_arrow.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace render_node {
namespace {

// Sizes in radii of the tool.
constexpr float kShaft = 0.16F;
constexpr float kHead = 0.42F;
constexpr float kHeadLength = 1.0F;
constexpr int kSides = 20;

// Colours in linear light, different from those of the sand and the tool.
const glm::vec3 kBlue(0.04F, 0.22F, 0.85F);
const glm::vec3 kMagenta(0.80F, 0.02F, 0.50F);

/// Circle around the arrow's axis.
struct Ring {
    float along, radius;  // [scene unit]
};

/// Adds the faces between two circles.
void addBand(std::vector<shapes::SolidVertex>& out, const ForceArrow& arrow, const Ring& low, const Ring& high) {
    const glm::vec3 axis = glm::normalize(arrow.to - arrow.from);
    const glm::vec3 aside = std::abs(axis.z) < 0.9F ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0);
    const glm::vec3 first = glm::normalize(glm::cross(aside, axis));
    const glm::vec3 second = glm::cross(axis, first);
    const auto at = [&](const Ring& ring, int side) {
        const float angle = glm::two_pi<float>() * static_cast<float>(side) / kSides;
        const glm::vec3 outward = std::cos(angle) * first + std::sin(angle) * second;
        const glm::vec3 normal = glm::normalize((high.along - low.along) * outward + (low.radius - high.radius) * axis);
        return shapes::SolidVertex{arrow.from + ring.along * axis + ring.radius * outward, normal, {0, 0}};
    };
    for (int side = 0; side < kSides; ++side) {
        for (const auto& [ring, step] :
             {std::pair{&low, 0}, {&low, 1}, {&high, 1}, {&low, 0}, {&high, 1}, {&high, 0}}) {
            out.push_back(at(*ring, side + step));
        }
    }
}

}  // namespace

std::vector<shapes::SolidVertex> makeArrow(const ForceArrow& arrow, float toolRadius) {
    const float length = glm::length(arrow.to - arrow.from);
    // A short arrow is a small arrow, so that it always has a shaft.
    const float size = toolRadius * std::min(1.0F, length / (1.5F * kHeadLength * toolRadius));
    const float neck = length - kHeadLength * size;
    std::vector<shapes::SolidVertex> triangles;
    addBand(triangles, arrow, {0, 0}, {0, kShaft * size});
    addBand(triangles, arrow, {0, kShaft * size}, {neck, kShaft * size});
    addBand(triangles, arrow, {neck, kShaft * size}, {neck, kHead * size});
    addBand(triangles, arrow, {neck, kHead * size}, {length, 0});
    return triangles;
}

shapes::Box boxOf(const ForceArrow& arrow, float toolRadius) {
    const double wide = 1.01 * double{kHead} * double{toolRadius};  // a little more, for rounding of GL's floats
    return {glm::dvec3(glm::min(arrow.from, arrow.to)) - wide, glm::dvec3(glm::max(arrow.from, arrow.to)) + wide};
}

void ForceArrowView::draw(const ForceArrow& arrow, float toolRadius) {
    mesh_.set(makeArrow(arrow, toolRadius));
    program_.set("uColour", arrow.longest ? kMagenta : kBlue);
    mesh_.draw();
}

}  // namespace render_node
