// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <deque>

#include "sand/tin/mesh/triangulation.hpp"

namespace sand::tin {

namespace {

/// Returns whether `ahead` and `to` lie on the same side of `from`. The three places must be on one line.
bool isAhead(const LatticePoint& from, const LatticePoint& to, const LatticePoint& ahead) {
    return std::int64_t{to.x - from.x} * (ahead.x - from.x) + std::int64_t{to.y - from.y} * (ahead.y - from.y) > 0;
}

/// Returns the lattice place nearest to the crossing of p–q and c–d, which must cross. It lies in the bounding boxes
/// of both.
LatticePoint nearestToCrossing(const LatticePoint& p, const LatticePoint& q, const LatticePoint& c,
                               const LatticePoint& d) {
    const auto cross = [](std::int64_t ax, std::int64_t ay, std::int64_t bx, std::int64_t by) {
        return ax * by - ay * bx;
    };
    std::int64_t part = cross(c.x - p.x, c.y - p.y, d.x - c.x, d.y - c.y);
    std::int64_t whole = cross(q.x - p.x, q.y - p.y, d.x - c.x, d.y - c.y);
    if (whole < 0) {
        part = -part;
        whole = -whole;
    }
    const auto along = [&](std::int32_t from, std::int32_t to) {
        // Halves round up, whatever the direction of the edge. The numbers reach 2^70.
        const Wide twice = static_cast<Wide>(2) * (to - from) * part + whole;
        const Wide divisor = static_cast<Wide>(2) * whole;
        const Wide down = twice >= 0 ? twice / divisor : -((-twice + divisor - 1) / divisor);
        return static_cast<std::int32_t>(from + down);
    };
    return {along(p.x, q.x), along(p.y, q.y)};
}

/// Returns whether a line from p to q may bend to e. It then bends by at most a unit, and does not turn back along an
/// axis.
bool isBeside(const LatticePoint& p, const LatticePoint& q, const LatticePoint& e) {
    const bool between = std::min(p.x, q.x) <= e.x && e.x <= std::max(p.x, q.x) && std::min(p.y, q.y) <= e.y &&
                         e.y <= std::max(p.y, q.y);
    return between && std::abs(doubledArea(p, q, e)) <= std::max(std::abs(q.x - p.x), std::abs(q.y - p.y));
}

/// Returns the place at which two crossing edges shall meet. This is an end of one edge that is within a unit of the
/// other, or else the lattice place nearest to the crossing.
///
/// Without the first rule, two almost parallel edges would cross again and again, ever nearer to the place where they
/// part. One crossing within two rows of the lattice became 100,000 crossings.
LatticePoint meetingPlace(const LatticePoint& p, const LatticePoint& q, const LatticePoint& c, const LatticePoint& d) {
    if (isBeside(p, q, c)) {
        return c;
    }
    if (isBeside(p, q, d)) {
        return d;
    }
    if (isBeside(c, d, p)) {
        return p;
    }
    return isBeside(c, d, q) ? q : nearestToCrossing(p, q, c, d);
}

VertexPair ascending(Vertex a, Vertex b) { return std::minmax(a, b); }

}  // namespace

Triangulation::Hit Triangulation::follow(Vertex from, Vertex to) const {
    const LatticePoint& start = place(from);
    const LatticePoint& end = place(to);
    Hit hit;
    Side side;  // across which the line leaves the triangle
    around(from, [&](const Side& spoke) {
        const Vertex right = ends(spoke).second;
        const Vertex left = triangle(spoke.slot).corner[spoke.opposite];
        for (const Vertex other : {right, left}) {
            if (area(from, to, other) == 0 && isAhead(start, end, place(other))) {
                hit.vertex = other;
                return true;
            }
        }
        if (area(from, to, right) < 0 && area(from, to, left) > 0) {
            side = {spoke.slot, next(spoke.opposite)};
            return true;
        }
        return false;
    });
    while (hit.vertex == kNoNumber) {
        hit.edge = ends(side);
        if (isConstrained(side)) {
            break;
        }
        hit.passed.push_back(hit.edge);
        const Side there = beyond(side);
        const Vertex apex = triangle(there.slot).corner[there.opposite];
        const std::int64_t where = area(from, to, apex);
        if (where == 0) {
            hit.vertex = apex;
        }
        // The line entered with the side's one end on its right and the other on its left. It leaves across the side
        // whose ends it separates.
        side = {there.slot, where > 0 ? next(there.opposite) : previous(there.opposite)};
    }
    return hit;
}

void Triangulation::carve(Vertex from, const Hit& hit) {
    std::deque<VertexPair> crossing(hit.passed.begin(), hit.passed.end());
    std::vector<VertexPair> made;
    while (!crossing.empty()) {
        const auto [a, b] = crossing.front();
        crossing.pop_front();
        const Side side = findEdge(a, b);
        if (!isConvex(side)) {
            crossing.emplace_back(a, b);  // other edges must be flipped first (Sloan 1993)
            continue;
        }
        const Vertex c = triangle(side.slot).corner[side.opposite];
        const Side there = beyond(side);
        const Vertex d = triangle(there.slot).corner[there.opposite];
        flip(side);
        const bool apart = c != from && c != hit.vertex && d != from && d != hit.vertex &&
                           (area(from, hit.vertex, c) > 0) != (area(from, hit.vertex, d) > 0);
        if (apart) {
            crossing.emplace_back(c, d);
        } else {
            made.emplace_back(c, d);
        }
    }
    setConstrained(findEdge(from, hit.vertex), true);
    improve(made);
}

Mesh::Path Triangulation::constrain(Vertex from, Vertex to) {
    Mesh::Path path{{from, to}, {}};
    std::vector<VertexPair> wanted{{from, to}};
    const auto bend = [&path](Vertex a, Vertex b, Vertex through) {
        for (std::size_t i = 0; i + 1 < path.vertices.size(); ++i) {
            if (ascending(path.vertices[i], path.vertices[i + 1]) == ascending(a, b)) {
                path.vertices.insert(path.vertices.begin() + static_cast<std::ptrdiff_t>(++i), through);
            }
        }
        const auto known = std::find(path.before.begin(), path.before.end(), ascending(a, b));
        if (known != path.before.end()) {
            *known = ascending(a, through);
            path.before.push_back(ascending(through, b));
        }
    };
    // The loop ends, because a wanted edge or a constraint bends only within its bounding box. Measured along the
    // axes, its two parts together are as long as the edge was. Each turn splits one edge in two or accepts it.
    while (!wanted.empty()) {
        const auto [a, b] = wanted.back();
        wanted.pop_back();
        const Hit hit = follow(a, b);
        if (hit.vertex != kNoNumber) {
            if (const Side side = findEdge(a, hit.vertex); side.slot != kNoNumber && isConstrained(side)) {
                path.before.push_back(ascending(a, hit.vertex));
            }
            carve(a, hit);
            if (hit.vertex != b) {
                bend(a, b, hit.vertex);
                wanted.emplace_back(hit.vertex, b);
            }
            continue;
        }
        const auto [c, d] = hit.edge;
        const LatticePoint crossing = meetingPlace(place(a), place(b), place(c), place(d));
        const Located where = find(crossing);
        if (cornerAt(where) == 3 && static_cast<std::size_t>(vertexCount_) >= mostVertices) {
            break;  // a state with more vertices could not be decoded
        }
        const VertexPair split = edgeAt(where);  // edge at the crossing, which insertAt() splits too
        const Vertex middle = insertAt(where, crossing, kNoNumber);
        bend(split.first, split.second, middle);
        wanted.emplace_back(a, b);
        if (middle != a && middle != b) {
            bend(a, b, middle);
            wanted.back() = {middle, b};
            wanted.emplace_back(a, middle);
        }
        // Split c–d too, unless insertAt() has just done that.
        if (middle != c && middle != d && findEdge(c, d).slot != kNoNumber && isConstrained(findEdge(c, d))) {
            bend(c, d, middle);
            release(c, d);
            wanted.emplace_back(middle, d);
            wanted.emplace_back(c, middle);
        }
    }
    return path;
}

}  // namespace sand::tin
