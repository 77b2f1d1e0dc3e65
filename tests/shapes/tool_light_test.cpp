// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numbers>

#include "base/names.hpp"
#include "sand/model/heading.hpp"
#include "shapes/tool/light.hpp"
#include "shapes/tool/mesh.hpp"
#include "tests/support/borders/tool_kinds.hpp"

namespace {

/// Returns the volume within the triangles of a tool of radius 1. Pieces that overlap count twice.
double volumeOf(const sand::Tool& tool) {
    double volume = 0;
    const std::vector<shapes::SolidVertex> triangles = shapes::makeTool(tool);
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        const glm::dvec3 a = triangles[i].position, b = triangles[i + 1].position, c = triangles[i + 2].position;
        volume += glm::dot(a, glm::cross(b, c)) / 6;
    }
    return volume;
}

// The ellipsoid around a plate is as wide, and its height is 0.6 radii for the plate's 0.25. So it has 2/3 * 0.6 / 0.25
// = 1.6 of the plate's volume. It has more of a sole's volume, because the pieces leave gaps. An ellipsoid is its own
// light. A new kind that is neither needs a case in ToolLight.
TEST(ToolLight, OfEachKindHasAboutItsVolume) {
    for (const sand::ToolKind kind : support::everyTool()) {
        sand::Tool tool;
        tool.kind = kind;
        tool.radius = 1000;
        tool.halfWidth = sand::isRound(kind) ? 0 : 600;
        tool.heading = sand::headingOf(25, false).value();
        const shapes::ToolLight light({tool, {}, 1, true});
        const double volume = 4 * std::numbers::pi / 3 / glm::determinant(light.toBall);
        EXPECT_GT(volume, 0.9 * volumeOf(tool)) << base::nameOf(kind);
        EXPECT_LT(volume, 2.5 * volumeOf(tool)) << base::nameOf(kind);
    }
}

}  // namespace
