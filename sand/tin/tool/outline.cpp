// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/tool/outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <span>

namespace sand::tin {
namespace {

constexpr double kMargin = 2;         // distance from the tool's edge [probe unit]: a rounded point stays below it
constexpr double kShortest = 18;      // shortest edge [probe unit]: a fourteenth of a cell
constexpr std::int32_t kMerging = 2;  // largest distance between two roundings of one crossing [probe unit]

/// A place in the tool's own axes: along its heading, and to its left [probe unit].
struct Own {
    double along, across;
};
using Polygon = std::vector<Own>;  // convex, counter-clockwise

/// Cosines of multiples of 11.25 degrees, in units of 2^-14 like headings. They are constants, so that no machine
/// computes them in its own way.
constexpr int kQuarter = 8;
constexpr std::array<int, kQuarter + 1> kCosines{16384, 16069, 15137, 13623, 11585, 9102, 6270, 3196, 0};

Own unitVector(int k /* of 32 */) {
    const auto step = static_cast<std::size_t>(k % kQuarter);
    const double c = kCosines.at(step) / 16384.0, s = kCosines.at(kQuarter - step) / 16384.0;
    constexpr std::array<std::array<double, 4>, 4> kTurns{{{1, 0, 0, 1}, {0, -1, 1, 0}, {-1, 0, 0, -1}, {0, 1, -1, 0}}};
    const auto& turn = kTurns.at(static_cast<std::size_t>(k / kQuarter % 4));
    return {turn[0] * c + turn[1] * s, turn[2] * c + turn[3] * s};
}

/// Returns the points of an ellipse, at most `most`. Their number is a power of two from 8 to 32. Returns an empty
/// polygon if even with 8 points the shortest edge would be too short.
Polygon ellipse(Own middle, double halfLength, double halfWidth, int most) {
    constexpr double kChord = 0.196;  // of 32 points on a circle of radius 1; nearly twice as long with 16 points
    const double narrow = std::min(halfLength, halfWidth);
    int count = most;
    while (count >= 8 && narrow * kChord * 32 / count < kShortest) {
        count /= 2;
    }
    Polygon points;
    for (int k = 0; count >= 8 && k < count; ++k) {
        const Own unit = unitVector(k * 32 / count);
        points.push_back({middle.along + halfLength * unit.along, middle.across + halfWidth * unit.across});
    }
    return points;
}

Polygon rectangle(double halfLength, double halfWidth) {
    int count = 8;
    while (count >= 2 && 2 * std::min(halfLength, halfWidth) / count < kShortest) {
        count /= 2;
    }
    if (count < 2) {
        return {};
    }
    Polygon points;
    constexpr std::array<std::array<double, 4>, 4> kSides{
        {{-1, -1, 1, 0}, {1, -1, 0, 1}, {1, 1, -1, 0}, {-1, 1, 0, -1}}};
    for (const auto& side : kSides) {
        for (int k = 0; k < count; ++k) {
            const double way = 2.0 * k / count;
            points.push_back({halfLength * (side[0] + side[2] * way), halfWidth * (side[1] + side[3] * way)});
        }
    }
    return points;
}

double cross(const Own& a, const Own& b, const Own& c) {
    return (b.along - a.along) * (c.across - a.across) - (b.across - a.across) * (c.along - a.along);
}

/// Returns the part of a segment that lies within a convex polygon, as shares of the segment. Returns nullopt if no
/// part does.
std::optional<std::pair<double, double>> inside(const Own& from, const Own& to, const Polygon& polygon) {
    double enters = 0, leaves = 1;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Own &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double before = cross(a, b, from), after = cross(a, b, to);
        if (before < 0 && after < 0) {
            return std::nullopt;
        }
        if (before < 0) {
            enters = std::max(enters, before / (before - after));
        } else if (after < 0) {
            leaves = std::min(leaves, before / (before - after));
        }
    }
    return enters < leaves ? std::optional(std::pair(enters, leaves)) : std::nullopt;
}

std::int32_t rounded(double value) { return static_cast<std::int32_t>(value < 0 ? value - 0.5 : value + 0.5); }

/// Collects points and edges in the tool's own axes.
class Drawing {
public:
    int point(const Own& own) {
        const LatticePoint place{rounded(own.along), rounded(own.across)};
        const auto same = std::find_if(outline_.points.begin(), outline_.points.end(), [&](const LatticePoint& other) {
            return std::abs(other.x - place.x) <= kMerging && std::abs(other.y - place.y) <= kMerging;
        });
        if (same == outline_.points.end()) {
            outline_.points.push_back(place);
            return static_cast<int>(outline_.points.size()) - 1;
        }
        return static_cast<int>(same - outline_.points.begin());
    }
    void edge(const Own& from, const Own& to) {
        const int a = point(from), b = point(to);
        if (a != b) {
            outline_.edges.emplace_back(a, b);
        }
    }
    /// Adds the edges of polygon `which`, without the parts that lie within other polygons.
    void ring(const std::vector<Polygon>& all, std::size_t which) {
        const Polygon& ring = all[which];
        for (std::size_t i = 0; i < ring.size(); ++i) {
            outside(ring[i], ring[(i + 1) % ring.size()], all, which);
        }
    }
    [[nodiscard]] Outline take() { return std::move(outline_); }

private:
    void outside(const Own& from, const Own& to, const std::vector<Polygon>& all, std::size_t which) {
        std::vector<std::pair<double, double>> hidden;
        for (std::size_t other = 0; other < all.size(); ++other) {
            const auto part = other == which ? std::nullopt : inside(from, to, all[other]);
            if (part) {
                hidden.push_back(*part);
            }
        }
        std::sort(hidden.begin(), hidden.end());  // equal pairs are interchangeable
        const auto at = [&](double share) {
            return Own{from.along + share * (to.along - from.along), from.across + share * (to.across - from.across)};
        };
        double seen = 0;
        for (const auto& [enters, leaves] : hidden) {
            if (enters > seen) {
                edge(at(seen), at(enters));
            }
            seen = std::max(seen, leaves);
        }
        if (seen < 1) {
            edge(at(seen), to);
        }
    }

    Outline outline_;
};

void drawSole(Drawing& drawing, std::span<const SolePiece> sole, double length, double width) {
    // A polygon of 16 points contains 0.98 of an ellipse, and one of 32 points 0.995. With fewer points, sand beside a
    // toe would reach into it.
    constexpr double kSmall = 0.2;  // [half length of the tool]
    std::vector<Polygon> pieces;
    for (const SolePiece& piece : sole) {
        pieces.push_back(ellipse({piece.along * length, piece.across * width}, piece.halfLength * length - kMargin,
                                 piece.halfWidth * width - kMargin, piece.halfLength < kSmall ? 16 : 32));
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        drawing.ring(pieces, i);
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (!pieces[i].empty()) {  // the deepest place of the piece's bowl
            drawing.point({sole[i].along * length, sole[i].across * width});
        }
    }
}

/// Adds rings of points at such shares of the radius that the surface between them is close to a bowl. It is above the
/// bowl by less than a fifteenth of the radius. This holds within 0.98 of the outline, if points of the mesh are a
/// sixth of the radius apart. A bowl is steepest at its outline, so that edges must join the points of the outer rings.
/// Otherwise triangles would reach from the outline over a ring. The narrow bowl of an ellipsoid needs more points
/// inside.
void drawBowl(Drawing& drawing, double length, double width) {
    const double narrowest = std::min(length, width);
    const auto ring = [&](double share) {
        const Polygon points = ellipse({0, 0}, share * length, share * width, 32);
        for (std::size_t i = 0; i < points.size(); ++i) {
            drawing.edge(points[i], points[(i + 1) % points.size()]);
        }
    };
    // A ring so close to its neighbour that its triangles would be slivers is left out.
    constexpr double kFirst = 0.96;
    if ((1 - kFirst) * narrowest >= kShortest) {
        ring(kFirst);
    }
    // Between the first ring and the outline, triangles are the higher above a bowl the longer it is, because the
    // outline is only kMargin within the tool. From this length on they need a second ring. Where a bowl is too narrow
    // for a ring at 0.99, the ring is farther inside.
    constexpr double kLong = 1800;  // [probe unit]: 7 cells
    const double second = std::min(0.99, 1 - kShortest / narrowest);
    if (length >= kLong && (second - kFirst) * narrowest >= kShortest) {
        ring(second);
    }
    const bool narrow = width < length;
    const auto inner = [&](double share, int count) {
        for (const Own& own : ellipse({0, 0}, share * length, share * width, count)) {
            drawing.point(own);
        }
    };
    inner(0.75, narrow ? 32 : 16);
    if (narrow) {
        inner(0.5, 16);
    }
    drawing.point({0, 0});
}

Outline drawn(const Tool& tool) {
    const double length = tool.radius, width = isRound(tool.kind) ? tool.radius : tool.halfWidth;
    Drawing drawing;
    if (const auto sole = solePieces(tool.kind); !sole.empty()) {
        drawSole(drawing, sole, length, width);
        return drawing.take();
    }
    const Polygon ring = tool.kind == ToolKind::rectangle ? rectangle(length - kMargin, width - kMargin)
                                                          : ellipse({0, 0}, length - kMargin, width - kMargin, 32);
    drawing.ring({ring}, 0);
    if ((tool.kind == ToolKind::sphere || tool.kind == ToolKind::ellipsoid) && !ring.empty()) {
        drawBowl(drawing, length, width);
    }
    return drawing.take();
}

std::int32_t scaled(std::int64_t way, std::int64_t numerator, std::int64_t denominator) {
    const std::int64_t product = 2 * way * numerator;  // below 2^46
    const std::int64_t half = (product < 0) == (denominator < 0) ? denominator : -denominator;
    return static_cast<std::int32_t>((product + half) / (2 * denominator));
}

/// Returns the part of an edge that lies in the rectangle, with its ends rounded to the lattice. Returns nullopt if no
/// part does, or if the part lies along the rim.
std::optional<std::pair<LatticePoint, LatticePoint>> clipped(LatticePoint a, LatticePoint b, std::int32_t width,
                                                             std::int32_t depth) {
    for (int side = 0; side < 4; ++side) {
        const bool alongX = side < 2;
        const std::int32_t limit = side % 2 == 0 ? 0 : (alongX ? width : depth);
        const auto beyond = [&](const LatticePoint& p) {
            const std::int32_t value = alongX ? p.x : p.y;
            return side % 2 == 0 ? value < limit : value > limit;
        };
        if (beyond(a) && beyond(b)) {
            return std::nullopt;
        }
        const auto cut = [&](const LatticePoint& out, const LatticePoint& in) {
            return alongX ? LatticePoint{limit, out.y + scaled(in.y - out.y, limit - out.x, in.x - out.x)}
                          : LatticePoint{out.x + scaled(in.x - out.x, limit - out.y, in.y - out.y), limit};
        };
        if (beyond(a)) {
            a = cut(a, b);
        } else if (beyond(b)) {
            b = cut(b, a);
        }
    }
    const bool alongRim = (a.x == b.x && (a.x == 0 || a.x == width)) || (a.y == b.y && (a.y == 0 || a.y == depth));
    return alongRim || a == b ? std::nullopt : std::optional(std::pair(a, b));
}

}  // namespace

Outline Outline::of(const Tool& tool) {
    Outline outline = drawn(tool);
    if (isRound(tool.kind)) {
        return outline;
    }
    const double x = tool.heading.x, y = tool.heading.y, scale = 1 / std::sqrt(x * x + y * y);
    for (LatticePoint& point : outline.points) {
        const double along = point.x, across = tool.heading.mirrored ? -point.y : point.y;
        point = {rounded((along * x - across * y) * scale), rounded((along * y + across * x) * scale)};
    }
    return outline;
}

namespace {

/// Calls visit(share) for each line x = lineOf(number) or y = lineOf(number) that an edge crosses between its ends,
/// with the share of the edge up to the crossing.
template <class LineOf, class Visit>
void forEachLine(std::int32_t from, std::int32_t to, int first, int last, const LineOf& lineOf, const Visit& visit) {
    for (int number = std::min(first, last); number <= std::max(first, last) + 1; ++number) {
        const std::int32_t line = lineOf(number);
        if ((from < line && line < to) || (to < line && line < from)) {
            visit(static_cast<double>(line - from) / (to - from), line, number);
        }
    }
}

/// Returns the parts of an edge that lie on ground. Each end between the ends of the edge is on the border of a hole.
/// Returns no parts if the edge comes near a place where two cells without ground touch at a corner.
std::vector<std::pair<LatticePoint, LatticePoint>> onGround(const LatticePoint& a, const LatticePoint& b,
                                                            const Holes& holes) {
    const Cells& cells = holes.cells();
    const int west = cells.columnOf(std::min(a.x, b.x) - holes.bridge());
    const int east = cells.columnOf(std::max(a.x, b.x) + holes.bridge());
    const int south = cells.rowOf(std::min(a.y, b.y) - holes.bridge());
    const int north = cells.rowOf(std::max(a.y, b.y) + holes.bridge());
    for (int row = south; row <= north + 1; ++row) {
        for (int column = west; column <= east + 1; ++column) {
            if (holes.isPinch(column, row)) {
                return {};
            }
        }
    }
    std::vector<std::pair<double, LatticePoint>> crossings;  // of borders, with their shares of the edge
    const auto along = [](std::int32_t from, std::int32_t to, double share) {
        return rounded(from + share * (static_cast<double>(to) - from));
    };
    const auto column = [&](std::int32_t x) { return cells.columnOf(x); };
    const auto row = [&](std::int32_t y) { return cells.rowOf(y); };
    forEachLine(
        a.x, b.x, column(a.x), column(b.x), [&](int number) { return cells.west(number); },
        [&](double share, std::int32_t x, int number) {
            const LatticePoint place{x, along(a.y, b.y, share)};
            if (holes.isHole(number - 1, row(place.y)) != holes.isHole(number, row(place.y))) {
                crossings.emplace_back(share, place);
            }
        });
    forEachLine(
        a.y, b.y, row(a.y), row(b.y), [&](int number) { return cells.south(number); },
        [&](double share, std::int32_t y, int number) {
            const LatticePoint place{along(a.x, b.x, share), y};
            if (holes.isHole(column(place.x), number - 1) != holes.isHole(column(place.x), number)) {
                crossings.emplace_back(share, place);
            }
        });
    std::sort(crossings.begin(), crossings.end());
    std::vector<std::pair<LatticePoint, LatticePoint>> parts;
    LatticePoint from = a;
    bool ground = !holes.holds(a);
    const auto end = [&](const LatticePoint& place) {
        if (ground && from != place) {
            parts.emplace_back(from, place);
        }
        ground = !ground;
        from = place;
    };
    for (const auto& [share, place] : crossings) {
        end(place);
    }
    end(b);
    return parts;
}

}  // namespace

PlacedOutline placed(const Outline& outline, std::int32_t x, std::int32_t y, const Triangles& field,
                     const Holes* holes) {
    PlacedOutline result;
    const auto add = [&](const LatticePoint& place) {
        if (std::find(result.points.begin(), result.points.end(), place) == result.points.end()) {
            result.points.push_back(place);
        }
    };
    std::vector<LatticePoint> places;
    for (const LatticePoint& offset : outline.points) {
        places.push_back({x + offset.x, y + offset.y});
        const LatticePoint& place = places.back();
        const bool inside = place.x >= 0 && place.y >= 0 && place.x <= field.width && place.y <= field.depth;
        if (inside && (holes == nullptr || !holes->holds(place))) {
            add(place);
        }
    }
    for (const auto& [from, to] : outline.edges) {
        const auto part = clipped(places[static_cast<std::size_t>(from)], places[static_cast<std::size_t>(to)],
                                  field.width, field.depth);
        const auto isNearHole = [&](const LatticePoint& a, const LatticePoint& b) {
            return holes != nullptr &&
                   holes->reachInto({std::min(a.x, b.x), std::min(a.y, b.y)}, {std::max(a.x, b.x), std::max(a.y, b.y)});
        };
        if (!part) {
            continue;
        }
        const auto parts =
            isNearHole(part->first, part->second) ? onGround(part->first, part->second, *holes) : std::vector{*part};
        for (const auto& edge : parts) {
            add(edge.first);
            add(edge.second);
            result.edges.push_back(edge);
        }
    }
    return result;
}

}  // namespace sand::tin
