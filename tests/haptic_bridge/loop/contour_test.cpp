// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sand/force/tool_contour.hpp"
#include "sand/grid/displacement.hpp"

namespace {

using sand::Heading;
using sand::Tool;
using sand::ToolKind;
using sand::force::Contour;
using sand::force::contourOf;
using sand::force::Vec3;

constexpr double kCell = 0.01;

Tool toolOf(ToolKind kind, const Heading& heading = {}) {
    const auto half = static_cast<std::int32_t>(20 * sand::kProbePerCell * sand::usualWidth(kind));
    return {kind, 20 * sand::kProbePerCell, sand::isRound(kind) ? 0 : half, heading};
}

TEST(Contour, OfASphereIsTheFirstPapers) {
    const Contour contour = contourOf(toolOf(ToolKind::sphere), kCell), paper = Contour::sphere(20 * kCell);
    for (std::size_t i = 0; i < Contour::kPoints; ++i) {
        EXPECT_EQ(contour.points[i].x, paper.points[i].x);
        EXPECT_EQ(contour.points[i].y, paper.points[i].y);
        EXPECT_EQ(contour.points[i].z, paper.points[i].z);
    }
}

TEST(Contour, LiesOnTheOutlineThatTheSandFeels) {
    for (int kind = 0; kind < sand::kToolKinds; ++kind) {
        for (const Heading& heading : {*sand::headingOf(0), *sand::headingOf(35), *sand::headingOf(35, true)}) {
            const Tool tool = toolOf(static_cast<ToolKind>(kind), heading);
            const sand::TurnedShape turned(tool);
            const Contour contour = contourOf(tool, kCell);
            // Across the gaps between toes and at the waist of a foot the contour is straight.
            const double close = (tool.kind == ToolKind::footprint ? 0.12 : 0.03) * tool.radius;
            for (const Vec3& point : contour.points) {
                int below = 0;
                for (int i = 0; i < 16; ++i) {
                    const double angle = 2 * std::numbers::pi * i / 16, probes = sand::kProbePerCell / kCell;
                    below += turned.covers({std::lround(probes * point.x + close * std::cos(angle)),
                                            std::lround(probes * point.y + close * std::sin(angle))})
                                 ? 1
                                 : 0;
                }
                EXPECT_TRUE(below > 0 && below < 16) << kind << " at " << point.x << ", " << point.y;
                EXPECT_GE(point.z, contour.lowest);
                EXPECT_LE(std::hypot(point.x, point.y), contour.reach * 1.001);
            }
        }
    }
}

// 32 points lie along the sides of a rectangle of 2 R x R, which is 6 R around. They begin at the middle of its back
// and are 3/16 R apart. The third is at (-R, -3/8 R) and is the farthest. A corner is 1.118 R away.
TEST(Contour, ARectanglesReachIsItsFarthestControlPoint) {
    const double radius = 20 * kCell;
    const Contour contour = contourOf(toolOf(ToolKind::rectangle), kCell);
    double farthest = 0;
    for (const Vec3& point : contour.points) {
        farthest = std::max(farthest, std::hypot(point.x, point.y));
    }
    // Sums of 512 pieces of about 0.01. Their rounding is below 512 times that of a double near 1.
    EXPECT_NEAR(contour.reach, farthest, 1e-12 * radius);
    EXPECT_NEAR(contour.reach, std::hypot(1, 3.0 / 8) * radius, 1e-12 * radius);
}

TEST(Contour, RunsCounterClockwiseInEqualPieces) {
    for (int kind = 0; kind < sand::kToolKinds; ++kind) {
        for (const bool mirrored : {false, true}) {
            const Contour contour =
                contourOf(toolOf(static_cast<ToolKind>(kind), *sand::headingOf(-70, mirrored)), kCell);
            double area = 0, shortest = 1e9, longest = 0;
            for (std::size_t i = 0; i < Contour::kPoints; ++i) {
                const Vec3& a = contour.points[i];
                const Vec3& b = contour.points[(i + 1) % Contour::kPoints];
                area += (a.x * b.y - a.y * b.x) / 2;
                const double piece = std::hypot(a.x - b.x, a.y - b.y);
                shortest = std::min(shortest, piece);
                longest = std::max(longest, piece);
            }
            EXPECT_GT(area, 0.02) << kind;
            // The pieces are equal along the outline. In a straight line they are shorter around corners and toes.
            const bool bent = static_cast<ToolKind>(kind) == ToolKind::footprint ||
                              static_cast<ToolKind>(kind) == ToolKind::rectangle;
            EXPECT_GT(shortest, (bent ? 0.2 : 0.97) * longest) << kind;
        }
    }
}

}  // namespace
