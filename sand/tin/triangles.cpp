// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/triangles.hpp"

#include <algorithm>

namespace sand::tin {
namespace {

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

std::array<Vertex, 3> sortedCorners(const Triangle& triangle) {
    std::array<Vertex, 3> corners = triangle.corner;
    std::sort(corners.begin(), corners.end());
    return corners;
}

Located weigh(const Triangles& mesh, std::int32_t slot, const Place& place) {
    const Triangle& triangle = mesh.triangles[at(slot)];
    const Place& a = mesh.places[at(triangle.corner[0])];
    const Place& b = mesh.places[at(triangle.corner[1])];
    const Place& c = mesh.places[at(triangle.corner[2])];
    return {slot, {doubledArea(b, c, place), doubledArea(c, a, place), doubledArea(a, b, place)}};
}

/// The slot with the smallest corners of those that share vertex `centre`.
std::int32_t firstAround(const Triangles& mesh, std::int32_t slot, Vertex centre) {
    std::int32_t first = slot;
    for (const std::size_t turn : {std::size_t{1}, std::size_t{2}}) {  // one way round, and the other from the rim
        for (std::int32_t next = slot;;) {
            const Triangle& triangle = mesh.triangles[at(next)];
            const auto corner = static_cast<std::size_t>(
                std::find(triangle.corner.begin(), triangle.corner.end(), centre) - triangle.corner.begin());
            next = triangle.neighbour[(corner + turn) % 3];
            if (next == slot) {
                return first;
            }
            if (next == kNobody) {
                break;
            }
            if (sortedCorners(mesh.triangles[at(next)]) < sortedCorners(mesh.triangles[at(first)])) {
                first = next;
            }
        }
    }
    return first;
}

}  // namespace

Located locate(const Triangles& mesh, Place place, std::int32_t from) {
    place = {std::clamp(place.x, 0, mesh.width), std::clamp(place.y, 0, mesh.depth)};
    const bool known = from >= 0 && at(from) < mesh.triangles.size() && mesh.triangles[at(from)].alive();
    std::int32_t slot = known ? from : mesh.triangleAt[0];
    // Always leaving by the first side beyond which the place lies could go round constraints for ever; chance cannot,
    // and where the walk ends does not depend on its way.
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
        } else if (zeros == 1 && here.weights[side] == 0 && next != kNobody &&
                   sortedCorners(mesh.triangles[at(next)]) < sortedCorners(triangle)) {
            first = next;
        }
    }
    return first == slot ? here : weigh(mesh, first, place);
}

}  // namespace sand::tin
