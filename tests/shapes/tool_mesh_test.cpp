// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "base/names.hpp"
#include "sand/model/heading.hpp"
#include "shapes/tool/mesh.hpp"
#include "tests/support/borders/tool_kinds.hpp"

namespace {

TEST(Sphere, HasTheAreaOfASphereAndFacesOutward) {
    const auto triangles = shapes::makeSphere(3);
    ASSERT_EQ(triangles.size(), 3U * 20 * 64);
    double area = 0;
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        const glm::dvec3 a = triangles[i].position;
        const glm::dvec3 b = triangles[i + 1].position;
        const glm::dvec3 c = triangles[i + 2].position;
        const glm::dvec3 twice = glm::cross(b - a, c - a);
        area += glm::length(twice) / 2;
        EXPECT_GT(glm::dot(twice, a + b + c), 0);
    }
    EXPECT_NEAR(area, 4 * 3.14159265, 0.1);
}

/// Returns a tool that is turned. Its width is not one at which a kind looks like another.
sand::Tool toolOf(sand::ToolKind kind) {
    sand::Tool tool;
    tool.kind = kind;
    tool.radius = 1000;
    tool.halfWidth = sand::isRound(kind) ? 0 : 600;
    tool.heading = sand::headingOf(25, false).value();
    return tool;
}

/// Returns the places of all corners in one order.
std::set<std::tuple<float, float, float>> cornersOf(const sand::Tool& tool) {
    std::set<std::tuple<float, float, float>> corners;
    for (const shapes::SolidVertex& vertex : shapes::makeTool(tool)) {
        corners.emplace(vertex.position.x, vertex.position.y, vertex.position.z);
    }
    return corners;
}

// Wall and page draw these triangles. A new kind without triangles of its own does not compile (solidOf), or is here.
TEST(ToolMesh, OfEachKindIsLikeNoOther) {
    std::set<std::set<std::tuple<float, float, float>>> all;
    for (const sand::ToolKind kind : support::everyTool()) {
        EXPECT_TRUE(all.insert(cornersOf(toolOf(kind))).second) << base::nameOf(kind);
    }
}

TEST(ToolMesh, OfEachKindIsWithinItsBox) {
    for (const sand::ToolKind kind : support::everyTool()) {
        const sand::Tool tool = toolOf(kind);
        const shapes::Box box = shapes::boxOfTool(tool);
        const std::vector<shapes::SolidVertex> triangles = shapes::makeTool(tool);
        ASSERT_FALSE(triangles.empty()) << base::nameOf(kind);
        EXPECT_TRUE(std::ranges::all_of(triangles, [&](const shapes::SolidVertex& vertex) {
            const glm::dvec3 at(vertex.position);
            return glm::all(glm::lessThanEqual(box.low, at)) && glm::all(glm::lessThanEqual(at, box.high));
        })) << base::nameOf(kind);
    }
}

TEST(ToolMesh, OfATurnedOrMirroredToolFacesOutward) {
    for (const sand::ToolKind kind : support::everyTool()) {
        for (const bool mirrored : {false, true}) {
            sand::Tool tool = toolOf(kind);
            tool.heading.mirrored = mirrored;
            const std::vector<shapes::SolidVertex> triangles = shapes::makeTool(tool);
            for (std::size_t i = 0; i < triangles.size(); i += 3) {
                const glm::vec3 a = triangles[i].position, b = triangles[i + 1].position, c = triangles[i + 2].position;
                const glm::vec3 normals = triangles[i].normal + triangles[i + 1].normal + triangles[i + 2].normal;
                ASSERT_GE(glm::dot(glm::cross(b - a, c - a), normals), 0)
                    << base::nameOf(kind) << ", triangle " << i / 3;
            }
        }
    }
}

}  // namespace
