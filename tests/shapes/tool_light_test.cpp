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

struct Bounds {
    double least, most;
};

/// Returns the volume of the light of a tool over that of its triangles.
Bounds lightOver(sand::ToolKind kind) {
    switch (kind) {
        using enum sand::ToolKind;
        case sphere:
        case ellipsoid:  // its own light; the triangles are within it
            return {1, 1.01};
        case circle:
        case ellipse:  // as wide as the plate, and 0.6 radii high for the plate's 0.25: 2/3 * 0.6 / 0.25, less the
                       // handle
            return {1.5, 1.6};
        case rectangle:  // 1.12 times as long and as wide: pi / 6 * 1.12 * 1.12 * 0.6 / 0.25 = 1.576, less the handle
            return {1.5, 1.576};
        case footprint:
            break;
    }
    return {1.6, 2.5};  // a sole: its pieces leave gaps in the plate. A kind that is no sole needs a case here.
}

TEST(ToolLight, OfEachKindHasAboutItsVolume) {
    for (const sand::ToolKind kind : support::everyTool()) {
        sand::Tool tool;
        tool.kind = kind;
        tool.radius = 1000;
        tool.halfWidth = sand::isRound(kind) ? 0 : 600;
        tool.heading = sand::headingOf(25, false).value();
        const shapes::ToolLight light({tool, {}, 1, true});
        const double volume = 4 * std::numbers::pi / 3 / glm::determinant(light.toBall);
        EXPECT_GT(volume, lightOver(kind).least * volumeOf(tool)) << base::nameOf(kind);
        EXPECT_LT(volume, lightOver(kind).most * volumeOf(tool)) << base::nameOf(kind);
    }
}

}  // namespace
