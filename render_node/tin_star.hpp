// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "sand/tin/triangles.hpp"

namespace render_node {

/// A triangle around a vertex, which is its corner number `corner`.
struct StarTriangle {
    std::int32_t slot;
    std::size_t corner;
};

/// The corner of a triangle that a vertex is, which must be one.
[[nodiscard]] inline std::size_t cornerOf(const sand::tin::Triangle& triangle, sand::tin::Vertex vertex) {
    return triangle.corner[0] == vertex ? 0 : triangle.corner[1] == vertex ? 1 : 2;
}

/// Visits the triangles around a vertex that lives, counter-clockwise: around a vertex on the rim from the first to the
/// last, around another from any on.
template <class Visit>  // void(const StarTriangle&)
void visitStar(const sand::tin::Triangles& mesh, sand::tin::Vertex vertex, const Visit& visit) {
    const auto triangle = [&](std::int32_t slot) -> const sand::tin::Triangle& {
        return mesh.triangles[static_cast<std::size_t>(slot)];
    };
    const std::int32_t any = mesh.triangleAt[static_cast<std::size_t>(vertex)];
    const auto beyond = [&](std::int32_t slot, std::size_t edge) {
        return triangle(slot).neighbour[(cornerOf(triangle(slot), vertex) + edge) % 3];
    };
    std::int32_t first = any;
    for (std::int32_t before = beyond(first, 2); before != sand::tin::kNobody; before = beyond(first, 2)) {
        first = before;
        if (first == any) {
            break;
        }
    }
    std::int32_t slot = first;
    do {
        visit(StarTriangle{slot, cornerOf(triangle(slot), vertex)});
        slot = beyond(slot, 1);
    } while (slot != sand::tin::kNobody && slot != first);
}

}  // namespace render_node
