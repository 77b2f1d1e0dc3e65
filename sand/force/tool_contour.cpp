// SPDX-License-Identifier: Apache-2.0
#include "sand/force/tool_contour.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include "sand/model/height_field.hpp"
#include "sand/model/tool_shape.hpp"

namespace sand::force {
namespace {

constexpr int kFine = 512;  // number of places that represent the outline

/// Places in the tool's own axes. The units are half its length and half its width. z is in radii above its lowest
/// point.
using Places = std::vector<Vec3>;

Vec3 onCircle(double turn) { return {std::cos(2 * std::numbers::pi * turn), std::sin(2 * std::numbers::pi * turn), 0}; }

/// Returns the last place of the sole along a ray from its middle.
Vec3 soleAlong(std::span<const SolePiece> sole, const Vec3& ray) {
    Vec3 farthest;
    double reach = 0;
    for (const SolePiece& piece : sole) {
        // Solves |t d - c| = 1 for the larger t, in the frame in which the piece is a unit circle.
        const double dx = ray.x / piece.halfLength, dy = ray.y / piece.halfWidth;
        const double cx = piece.along / piece.halfLength, cy = piece.across / piece.halfWidth;
        const double a = dx * dx + dy * dy, b = dx * cx + dy * cy, c = cx * cx + cy * cy - 1;
        const double root = b * b - a * c;
        if (root >= 0 && (b + std::sqrt(root)) / a > reach) {
            reach = (b + std::sqrt(root)) / a;
            farthest = {reach * ray.x, reach * ray.y, piece.lift + piece.bulge};
        }
    }
    return farthest;
}

/// Returns the outline without the gaps between toes: it goes straight from one toe to the next.
Places bridged(const Places& outline) {
    const double ball = 0.4 * std::max_element(outline.begin(), outline.end(), [](const Vec3& a, const Vec3& b) {
                                  return a.x < b.x;
                              })->x;
    Places result;
    for (const Vec3& place : outline) {
        // The last place lies in a gap if it is to the right of the line from the place before it to `place`.
        while (result.size() >= 2 && result[result.size() - 2].x > ball) {
            const Vec3 way = place - result[result.size() - 2], last = result.back() - result[result.size() - 2];
            if (way.x * last.y - way.y * last.x < 0) {
                break;
            }
            result.pop_back();
        }
        result.push_back(place);
    }
    return result;
}

Vec3 outlineAt(ToolKind kind, double turn) {
    const Vec3 place = onCircle(turn);
    if (kind == ToolKind::rectangle) {
        return (1 / std::max(std::abs(place.x), std::abs(place.y))) * place;
    }
    const std::span<const SolePiece> sole = solePieces(kind);
    return sole.empty() ? place : soleAlong(sole, place);
}

/// Returns kPoints places at equal distances along the outline.
Places evenly(const Places& outline) {
    std::vector<double> way{0};  // length of the outline up to each place, and back to the first [scene unit]
    const auto flat = [](const Vec3& a, const Vec3& b) { return std::hypot(a.x - b.x, a.y - b.y); };
    for (std::size_t i = 0; i < outline.size(); ++i) {
        way.push_back(way.back() + flat(outline[i], outline[(i + 1) % outline.size()]));
    }
    Places even;
    std::size_t at = 0;
    for (int i = 0; i < Contour::kPoints; ++i) {
        const double here = way.back() * i / Contour::kPoints;
        while (way[at + 1] < here) {
            ++at;
        }
        const double length = way[at + 1] - way[at];
        const double share = length > 0 ? (here - way[at]) / length : 0;
        const Vec3 from = outline[at], to = outline[(at + 1) % outline.size()];
        even.push_back(from + share * (to - from));
    }
    return even;
}

}  // namespace

Contour contourOf(const Tool& tool, double cellSize) {
    const double unit = probeUnit(cellSize);
    const double radius = unit * tool.radius;
    if (isRound(tool.kind)) {
        return Contour::sphere(radius);
    }
    const double width = unit * tool.halfWidth;
    Places outline;
    for (int i = 0; i < kFine; ++i) {
        const Vec3 place = outlineAt(tool.kind, 0.5 + static_cast<double>(i) / kFine);  // begins at the heel
        outline.push_back({radius * place.x, width * place.y, radius * (place.z - 1)});
    }
    const double cosine = static_cast<double>(tool.heading.x) / Heading::kLength;
    const double sine = static_cast<double>(tool.heading.y) / Heading::kLength;
    const Places even = evenly(tool.kind == ToolKind::footprint ? bridged(outline) : outline);
    Contour contour{{}, 0, -radius};
    for (std::size_t i = 0; i < even.size(); ++i) {
        // The points of a mirrored tool run clockwise, so that they are taken from the last to the first.
        const Vec3 place = even[tool.heading.mirrored ? (even.size() - i) % even.size() : i];
        const double across = tool.heading.mirrored ? -place.y : place.y;
        contour.points[i] = {cosine * place.x - sine * across, sine * place.x + cosine * across, place.z};
        contour.reach = std::max(contour.reach, std::hypot(place.x, place.y));
    }
    return contour;
}

}  // namespace sand::force
