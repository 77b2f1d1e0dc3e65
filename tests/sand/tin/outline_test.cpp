// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/tool/outline.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace {

using sand::Heading;
using sand::Tool;
using sand::ToolKind;
using sand::tin::LatticePoint;
using sand::tin::Outline;

Tool toolOf(int kind, std::int32_t radius, const Heading& heading = {}) {
    const auto which = static_cast<ToolKind>(kind);
    const auto width = static_cast<std::int32_t>(radius * sand::usualWidth(which));
    return {which, radius, sand::isRound(which) ? 0 : width, heading};
}

std::string nameOf(const Tool& tool) {
    return fmt::format("{} of radius {}, heading {} {}", base::nameOf(tool.kind), tool.radius, tool.heading.x,
                       tool.heading.y);
}

template <class Check>
void forEveryTool(const Check& check) {
    for (int kind = 0; kind < sand::kToolKinds; ++kind) {
        for (const std::int32_t radius : {100, 655, 3072, 100000}) {
            for (const double degrees : {0.0, 17.3, 90.0, 211.0}) {
                for (const bool mirrored : {false, true}) {
                    const Tool tool = toolOf(kind, radius, *sand::headingOf(degrees, mirrored));
                    SCOPED_TRACE(nameOf(tool));
                    check(tool, Outline::of(tool));
                }
            }
        }
    }
}

TEST(Outline, EveryPointLiesBelowTheTool) {
    forEveryTool([](const Tool& tool, const Outline& outline) {
        const sand::TurnedShape turned(tool);
        for (const LatticePoint& point : outline.points) {
            EXPECT_TRUE(turned.covers({point.x, point.y})) << point.x << ' ' << point.y;
        }
        EXPECT_TRUE(tool.kind == ToolKind::footprint || !outline.points.empty());
    });
}

TEST(Outline, EdgesMakeClosedRings) {
    forEveryTool([](const Tool& tool, const Outline& outline) {
        std::map<int, int> ends;
        for (const auto& [a, b] : outline.edges) {
            EXPECT_NE(a, b);
            ++ends[a];
            ++ends[b];
        }
        for (const auto& [point, count] : ends) {
            const LatticePoint& place = outline.points[static_cast<std::size_t>(point)];
            EXPECT_EQ(count, 2) << "edges end at " << place.x << ' ' << place.y;
        }
        if (tool.radius >= 655 && sand::solePieces(tool.kind).empty()) {
            const bool bowl = tool.kind == ToolKind::sphere || tool.kind == ToolKind::ellipsoid;
            const double narrow = bowl && tool.halfWidth > 0 ? tool.halfWidth : tool.radius;
            // A bowl has a ring at 0.96 and, from a radius of 7 cells on, another one between it and the outline. Rings
            // nearer to each other than 18 probe units are left out.
            const bool first = bowl && 0.04 * narrow >= 18, second = tool.radius >= 1800 && 0.04 * narrow >= 36;
            EXPECT_EQ(outline.edges.size(), 32U * (1U + (first ? 1U : 0U) + (first && second ? 1U : 0U)));
        }
    });
}

TEST(Outline, ASoleHasFourPartsWhoseOutlinesDoNotCross) {
    const Outline outline = Outline::of(toolOf(static_cast<int>(ToolKind::footprint), 3072));
    std::vector<int> part(outline.points.size());
    for (std::size_t i = 0; i < part.size(); ++i) {
        part[i] = static_cast<int>(i);
    }
    std::size_t rings = 0;
    for (const auto& [a, b] : outline.edges) {
        const int from = part[static_cast<std::size_t>(a)], to = part[static_cast<std::size_t>(b)];
        rings += from == to ? 1 : 0;  // this edge closes a ring
        std::replace(part.begin(), part.end(), from, to);
    }
    // The big toe with the second one, two toes, and the rest of the sole with the small toe. The ellipses of the big
    // and the second toe overlap: at the nearest place the level of one is 0.88 on the other.
    EXPECT_EQ(rings, 4U);
    for (const auto& [a, b] : outline.edges) {
        for (const auto& [c, d] : outline.edges) {
            const auto at = [&](int i) { return outline.points[static_cast<std::size_t>(i)]; };
            const auto side = [&](int i, int j, int k) { return sand::tin::doubledArea(at(i), at(j), at(k)); };
            const bool cross = (side(a, b, c) > 0) != (side(a, b, d) > 0) && (side(c, d, a) > 0) != (side(c, d, b) > 0);
            EXPECT_FALSE(cross && a != c && a != d && b != c && b != d) << a << '-' << b << ' ' << c << '-' << d;
        }
    }
}

/// Returns whether a place is inside the rings of an outline, by the number of edges that are east of it.
bool isInside(const Outline& outline, const LatticePoint& place) {
    bool inside = false;
    for (const auto& [from, to] : outline.edges) {
        const LatticePoint &a = outline.points[static_cast<std::size_t>(from)],
                           &b = outline.points[static_cast<std::size_t>(to)];
        if ((a.y > place.y) != (b.y > place.y)) {
            const LatticePoint &low = a.y < b.y ? a : b, &high = a.y < b.y ? b : a;
            inside = inside != (sand::tin::doubledArea(low, high, place) > 0);
        }
    }
    return inside;
}

// A polygon of 16 points holds cos(180/16 degrees) = 0.981 of an ellipse. Its points are two probe units within the
// ellipse, which is 0.013 of the smallest toe's width here.
TEST(Outline, OfASoleHoldsNearlyAllOfEachPiece) {
    for (const std::int32_t radius : {3072, 100000}) {
        const Tool tool = toolOf(static_cast<int>(ToolKind::footprint), radius);
        const Outline outline = Outline::of(tool);
        for (const sand::SolePiece& piece : sand::solePieces(tool.kind)) {
            for (int degrees = 0; degrees < 360; degrees += 3) {
                const double angle = degrees / 57.29578;
                const double along = piece.along + 0.96 * piece.halfLength * std::cos(angle);
                const double across = piece.across + 0.96 * piece.halfWidth * std::sin(angle);
                const LatticePoint place{static_cast<std::int32_t>(along * tool.radius),
                                         static_cast<std::int32_t>(across * tool.halfWidth)};
                EXPECT_TRUE(isInside(outline, place)) << radius << ": " << place.x << ", " << place.y;
            }
        }
    }
}

TEST(Outline, AToolTurnedByARightAngleHasItsPointsTurned) {
    for (int kind = 0; kind < sand::kToolKinds; ++kind) {
        const Heading heading = *sand::headingOf(17.3);
        const Tool tool = toolOf(kind, 2000, heading);
        const Heading turned{static_cast<std::int16_t>(-heading.y), heading.x, false};
        const Outline before = Outline::of(tool), after = Outline::of(tool.turnedTo(turned));
        EXPECT_EQ(before.edges, after.edges);
        std::vector<LatticePoint> expected, points = after.points;
        for (const LatticePoint& point : before.points) {
            expected.push_back(sand::isRound(tool.kind) ? point : LatticePoint{-point.y, point.x});
        }
        EXPECT_EQ(points, expected) << nameOf(tool);
    }
}

TEST(Outline, AToolOfNoSizeHasNoPoints) {
    for (int kind = 0; kind < sand::kToolKinds; ++kind) {
        for (const std::int32_t radius : {0, 1, 5, 20}) {
            EXPECT_TRUE(Outline::of(toolOf(kind, radius)).points.empty()) << nameOf(toolOf(kind, radius));
        }
    }
}

TEST(Outline, EndsAtTheRim) {
    sand::tin::Triangles field;
    field.width = 5000;
    field.depth = 3000;
    for (int kind = 0; kind < sand::kToolKinds; ++kind) {
        const Outline outline = Outline::of(toolOf(kind, 2000, *sand::headingOf(33)));
        for (const auto& [x, y] : {std::pair{0, 0}, {5000, 10}, {4990, 3000}, {-10, 1500}, {2500, 1500}, {-5000, 0}}) {
            const auto placed = sand::tin::placed(outline, x, y, field);
            for (const auto& [from, to] : placed.edges) {
                EXPECT_FALSE(from == to);
                for (const LatticePoint& end : {from, to}) {
                    EXPECT_TRUE(end.x >= 0 && end.y >= 0 && end.x <= field.width && end.y <= field.depth);
                    EXPECT_EQ(std::count(placed.points.begin(), placed.points.end(), end), 1);
                }
                EXPECT_FALSE(from.x == to.x && (from.x == 0 || from.x == field.width)) << "an edge along the rim";
            }
        }
        const auto corner = sand::tin::placed(outline, 0, 0, field);
        const auto onRim = [](const LatticePoint& p) { return p.x == 0 || p.y == 0; };
        EXPECT_GE(std::count_if(corner.points.begin(), corner.points.end(), onRim), 2) << kind;
        EXPECT_TRUE(sand::tin::placed(outline, -5000, 0, field).points.empty());
    }
}

}  // namespace
