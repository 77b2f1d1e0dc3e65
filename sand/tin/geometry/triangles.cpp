// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/geometry/triangles.hpp"

#include <algorithm>

namespace sand::tin {
namespace {

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

std::array<Vertex, 3> sortedCorners(const Triangle& triangle) {
    std::array<Vertex, 3> corners = triangle.corner;
    std::sort(corners.begin(), corners.end());
    return corners;
}

Located weigh(const Triangles& mesh, std::int32_t slot, const LatticePoint& place) {
    const Triangle& triangle = mesh.triangles[at(slot)];
    const LatticePoint& a = mesh.places[at(triangle.corner[0])];
    const LatticePoint& b = mesh.places[at(triangle.corner[1])];
    const LatticePoint& c = mesh.places[at(triangle.corner[2])];
    return {slot, {doubledArea(b, c, place), doubledArea(c, a, place), doubledArea(a, b, place)}};
}

/// Returns the slot of the triangle around vertex `centre` whose sorted corners come first. `slot` is one of these
/// triangles.
std::int32_t firstAround(const Triangles& mesh, std::int32_t slot, Vertex centre) {
    std::int32_t first = slot;
    for (const std::size_t turn : {std::size_t{1}, std::size_t{2}}) {  // one way, and the other way if it met the rim
        for (std::int32_t next = slot;;) {
            const Triangle& triangle = mesh.triangles[at(next)];
            const auto corner = static_cast<std::size_t>(
                std::find(triangle.corner.begin(), triangle.corner.end(), centre) - triangle.corner.begin());
            next = triangle.neighbour[(corner + turn) % 3];
            if (next == slot) {
                return first;
            }
            if (next == kNoNumber) {
                break;
            }
            if (sortedCorners(mesh.triangles[at(next)]) < sortedCorners(mesh.triangles[at(first)])) {
                first = next;
            }
        }
    }
    return first;
}

double squaredWay(const LatticePoint& a, const LatticePoint& b) {
    const double x = a.x - b.x, y = a.y - b.y;
    return x * x + y * y;
}

/// Returns the slot where a walk to `place` begins. That is `slot`, or, if `slot` is far away, a triangle at one of
/// some vertices all over the mesh (Mücke, Saias and Zhu 1996). Almost every triangle of a walk misses all caches, and
/// its load waits for the load before. The loads of the vertices do not wait for one another.
std::int32_t nearer(const Triangles& mesh, std::int32_t slot, const LatticePoint& place) {
    constexpr std::size_t kTried = 256;    // most vertices that are tried
    constexpr std::size_t kTogether = 64;  // only one vertex in 64 is tried, because a short walk is as fast
    constexpr std::size_t kLeap = 40503;   // odd, and no multiple of a likely row length of a scene's vertices
    const std::size_t count = mesh.places.size(), tried = std::min(count / kTogether, kTried);
    double nearest = squaredWay(mesh.places[at(mesh.triangles[at(slot)].corner[0])], place);
    if (tried == 0 || nearest * static_cast<double>(tried) < 4 * static_cast<double>(mesh.width) * mesh.depth) {
        return slot;
    }
    std::size_t found = count;
    for (std::size_t i = 0, vertex = 0; i < tried; ++i, vertex = (vertex + kLeap) % count) {
        if (const double way = squaredWay(mesh.places[vertex], place); way < nearest) {
            nearest = way;
            found = vertex;
        }
    }
    return found < count && mesh.triangleAt[found] != kNoNumber ? mesh.triangleAt[found] : slot;
}

}  // namespace

Located locate(const Triangles& mesh, LatticePoint place, std::int32_t from) {
    place = {std::clamp(place.x, 0, mesh.width), std::clamp(place.y, 0, mesh.depth)};
    const bool known = from >= 0 && at(from) < mesh.triangles.size() && mesh.triangles[at(from)].alive();
    std::int32_t slot = nearer(mesh, known ? from : mesh.triangleAt[0], place);
    // A walk that always leaves by the first side beyond which the place lies could circle around constraints without
    // end. A random side avoids that. The end of the walk does not depend on its way.
    std::uint32_t chance = 1;
    Located here = weigh(mesh, slot, place);
    for (;;) {
        const Triangle& triangle = mesh.triangles[at(slot)];
        chance = chance * 1664525U + 1013904223U;
        std::size_t side = (chance >> 16U) % 3;
        std::size_t tried = 0;
        while (tried < 3 && here.weights[side] >= 0) {
            side = side == 2 ? 0 : side + 1;
            ++tried;
        }
        if (tried == 3) {
            break;
        }
        slot = triangle.neighbour[side];
        here = weigh(mesh, slot, place);
    }
    const auto zeros = std::count(here.weights.begin(), here.weights.end(), 0);
    if (zeros == 0) {
        return here;
    }
    const Triangle& triangle = mesh.triangles[at(slot)];
    std::int32_t first = slot;
    for (std::size_t side = 0; side < 3; ++side) {
        const std::int32_t next = triangle.neighbour[side];
        if (zeros == 2 && here.weights[side] > 0) {
            first = firstAround(mesh, slot, triangle.corner[side]);
        } else if (zeros == 1 && here.weights[side] == 0 && next != kNoNumber &&
                   sortedCorners(mesh.triangles[at(next)]) < sortedCorners(triangle)) {
            first = next;
        }
    }
    return first == slot ? here : weigh(mesh, first, place);
}

}  // namespace sand::tin
