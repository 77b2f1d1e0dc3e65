// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/refine/coarsening.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace sand::tin {
namespace {

constexpr int kLooksPerRemoval = 16;
constexpr std::size_t kMostAround = 64;  // vertices with more neighbours stay, because they cost too much

/// Returns the largest distance of a vertex and its neighbours from the plane that fits them best [unit]. The vertex
/// is the origin, so that the sums are of products of small numbers.
double farthestFromPlane(const VertexSand& layer, Vertex vertex, const Link& link) {
    const auto& places = layer.triangles().places;
    const LatticePoint origin = places[static_cast<std::size_t>(vertex)];
    const double base = layer.heights()[static_cast<std::size_t>(vertex)];
    struct Point {
        double x, y, z;
    };
    std::array<Point, kMostAround + 1> all{};
    const std::span<Point> points(all.data(), link.vertices.size() + 1);  // the vertex itself first
    Point sum{};
    for (std::size_t i = 0; i < link.vertices.size(); ++i) {
        const auto other = static_cast<std::size_t>(link.vertices[i]);
        const Point point{static_cast<double>(places[other].x - origin.x),
                          static_cast<double>(places[other].y - origin.y), layer.heights()[other] - base};
        points[i + 1] = point;
        sum = {sum.x + point.x, sum.y + point.y, sum.z + point.z};
    }
    const auto count = static_cast<double>(points.size());
    double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0;
    for (Point& point : points) {
        point = {point.x - sum.x / count, point.y - sum.y / count, point.z - sum.z / count};
        xx += point.x * point.x;
        xy += point.x * point.y;
        yy += point.y * point.y;
        xz += point.x * point.z;
        yz += point.y * point.z;
    }
    const double determinant = xx * yy - xy * xy;  // positive, because the points do not all lie on a line
    const double a = (xz * yy - yz * xy) / determinant, b = (yz * xx - xz * xy) / determinant;
    double farthest = 0;
    for (const Point& point : points) {
        farthest = std::max(farthest, std::abs(point.z - a * point.x - b * point.y));
    }
    return farthest;
}

/// Removes the vertex if rules and surface allow that. Returns whether it was removed.
bool takeOut(VertexSand& layer, const DetailRules& rules, Vertex vertex, Link& link) {
    findLink(layer.triangles(), vertex, link);
    // The triangles before and after the removal have the same vertices except the removed one. All vertices lie
    // within `far` of a plane, so that both surfaces do. They are therefore at most 2 `far` apart. The remap moves
    // them by at most the mean of this distance. This holds on the rim too, because the rim is straight at the vertex.
    return !link.constrained && !link.bordered && (link.closed || !rules.keepsRim) &&
           link.vertices.size() <= kMostAround && 4 * farthestFromPlane(layer, vertex, link) <= rules.maxError &&
           layer.remove(vertex);
}

/// Returns the number of vertices that may be removed, with those that the mesh no longer has.
std::int64_t candidatesIn(const VertexSand& layer, const DetailRules& rules) {
    const auto count = static_cast<std::int64_t>(layer.triangles().triangleAt.size());
    return std::max<std::int64_t>(count - rules.firstToGo, 0);
}

/// Returns how many vertices a step may examine.
std::int64_t mostLooks(const DetailRules& rules) { return std::int64_t{rules.removals} * kLooksPerRemoval; }

/// Examines the vertices for which `maySkip` is false. Calls `looked` with each vertex, whether it was removed, and
/// its neighbours.
template <class MaySkip, class Looked>
int coarsenBut(VertexSand& layer, const DetailRules& rules, Vertex& next, const Box& keepOut, const MaySkip& maySkip,
               const Looked& looked) {
    if (rules.maxError <= 0) {
        return 0;
    }
    const auto count = static_cast<Vertex>(layer.triangles().triangleAt.size());
    const std::int64_t looks = std::min(candidatesIn(layer, rules), mostLooks(rules));
    Link link;
    int removed = 0;
    for (std::int64_t look = 0; look < looks && removed < rules.removals; ++look, ++next) {
        next = next >= count || next < rules.firstToGo ? rules.firstToGo : next;
        const Triangles& mesh = layer.triangles();
        if (maySkip(next) || !mesh.alive(next) || keepOut.holds(mesh.places[index(next)])) {
            continue;
        }
        const bool went = takeOut(layer, rules, next, link);
        removed += went ? 1 : 0;
        looked(next, went, link.vertices);
    }
    return removed;
}

}  // namespace

int coarsen(VertexSand& layer, const DetailRules& rules, Vertex& next, const Box& keepOut) {
    return coarsenBut(
        layer, rules, next, keepOut, [](Vertex) { return false; }, [](Vertex, bool, const std::vector<Vertex>&) {});
}

int Coarsening::step(VertexSand& layer, const DetailRules& rules, Vertex& next, const Box& keepOut) {
    known_.resize(std::max(known_.size(), layer.triangles().triangleAt.size()), 0);
    const auto looked = [&](Vertex vertex, bool went, const std::vector<Vertex>& around) {
        if (went) {  // the neighbours rose or sank, and the next vertex may be beside one of them
            touch(layer.triangles(), around);
            return;
        }
        known_[index(vertex)] = kFailed;
        for (const Vertex other : around) {
            known_[index(other)] &= static_cast<std::uint8_t>(~kNoneFailed);
        }
    };
    const int removed = coarsenBut(
        layer, rules, next, keepOut, [this](Vertex vertex) { return (known_[index(vertex)] & kFailed) != 0; }, looked);
    looked_ = removed > 0 ? 0 : looked_ + mostLooks(rules);
    done_ = looked_ >= candidatesIn(layer, rules);
    return removed;
}

void Coarsening::lookAgain(const Triangle& triangle) {
    for (const Vertex corner : triangle.corner) {
        if (index(corner) < known_.size()) {
            known_[index(corner)] &= static_cast<std::uint8_t>(~kFailed);
        }
    }
}

void Coarsening::touch(const Triangles& mesh, std::span<const Vertex> vertices) {
    looked_ = 0;
    done_ = false;
    known_.resize(std::max(known_.size(), mesh.triangleAt.size()), 0);
    for (const Vertex vertex : vertices) {
        // A vertex that is removed and comes back has only new triangles.
        if ((known_[index(vertex)] & kNoneFailed) == 0 && mesh.alive(vertex)) {
            aroundVertex(mesh, vertex, [&](std::int32_t slot, int) { lookAgain(mesh.triangles[index(slot)]); });
            known_[index(vertex)] |= kNoneFailed;
        }
    }
}

void Coarsening::touch(const Triangles& mesh, const Mesh::Change& change) {
    touch(mesh, change.vertices);
    for (const std::int32_t slot : change.triangles) {
        if (mesh.triangles[index(slot)].alive()) {
            lookAgain(mesh.triangles[index(slot)]);
        }
    }
}

}  // namespace sand::tin
