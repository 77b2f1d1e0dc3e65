// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sand::tin {

inline constexpr std::int32_t kLatticePerCell = 256;  // sand::kProbePerCell

__extension__ using Wide = __int128;

/// A place on the lattice all vertices lie on [probe unit = cell size / 256], from the field's south-west corner: x
/// runs east, y north. Any two differences of such coordinates multiply exactly in 64 bits.
struct Place {
    std::int32_t x = 0, y = 0;
    friend bool operator==(const Place&, const Place&) = default;
    // clang-tidy 14 complains of the 0 it finds in here itself. NOLINTNEXTLINE(modernize-use-nullptr)
    friend auto operator<=>(const Place&, const Place&) = default;
};

/// Twice the area of the triangle a, b, c [probe unit²], positive when it runs counter-clockwise. Exact.
[[nodiscard]] constexpr std::int64_t doubledArea(const Place& a, const Place& b, const Place& c) {
    return std::int64_t{b.x - a.x} * (c.y - a.y) - std::int64_t{b.y - a.y} * (c.x - a.x);
}

/// By number. A number stays a vertex's own while it lives, and is given again, the smallest free one first.
using Vertex = std::int32_t;
inline constexpr std::int32_t kNobody = -1;

/// The place in an array of what has such a number.
[[nodiscard]] constexpr std::size_t index(std::int32_t number) { return static_cast<std::size_t>(number); }

/// Corners counter-clockwise; neighbour[k] and constrained[k] are of the edge opposite corner[k].
struct Triangle {
    std::array<Vertex, 3> corner{kNobody, kNobody, kNobody};
    std::array<std::int32_t, 3> neighbour{kNobody, kNobody, kNobody};  // by slot; kNobody across the field's rim
    std::array<bool, 3> constrained{};                                 // the rim's edges always are
    bool hole = false;                                                 // no ground: cells without data (holes.hpp)
    [[nodiscard]] bool alive() const { return corner[0] != kNobody; }
    [[nodiscard]] bool isGround() const { return alive() && !hole; }
};

/// A triangulated field as whoever draws, feels or erodes it reads it: plain arrays, some of whose slots are empty.
///
/// Places and triangles as a set are a function of the vertices and the constraints alone; the slots of triangles and
/// the order of their corners are not, and nothing that is state may follow from them.
struct Triangles {
    std::vector<Place> places;             // by vertex
    std::vector<std::int32_t> triangleAt;  // by vertex: the slot of one of its triangles; kNobody: no such vertex
    std::vector<Triangle> triangles;       // by slot
    std::int32_t width = 0, depth = 0;     // of the field [probe unit]: the rectangle from (0, 0)
    [[nodiscard]] bool alive(Vertex vertex) const {
        return vertex >= 0 && vertex < static_cast<Vertex>(triangleAt.size()) &&
               triangleAt[static_cast<std::size_t>(vertex)] != kNobody;
    }
};

/// Whether a place within the field lies on its rim.
[[nodiscard]] constexpr bool isOnRim(const Triangles& mesh, const Place& place) {
    return place.x == 0 || place.y == 0 || place.x == mesh.width || place.y == mesh.depth;
}

/// Where a place lies: in this triangle or on its edges.
struct Located {
    std::int32_t triangle = kNobody;        // slot
    std::array<std::int64_t, 3> weights{};  // doubled areas opposite the corners; their sum is the triangle's
};

/// Walks from the triangle `from` (or any, when it is none) to the one that holds `place`, which is clamped to the
/// field first. The result is a function of the mesh and the place alone: of several triangles that share it, the one
/// whose corners are smallest in order. Costs as many triangles as lie between: start from the last one found.
[[nodiscard]] Located locate(const Triangles& mesh, Place place, std::int32_t from);

/// Calls visit(slot, corner) for every triangle around a vertex that lives, `corner` being the vertex's own: around one
/// on the rim in no certain order, around another counter-clockwise from any on.
template <class Visit>
void aroundVertex(const Triangles& mesh, Vertex vertex, const Visit& visit) {
    const auto cornerOf = [vertex](const Triangle& triangle) {
        // Without a branch: which it is nobody can foretell.
        return static_cast<int>(triangle.corner[1] == vertex) + 2 * static_cast<int>(triangle.corner[2] == vertex);
    };
    constexpr std::array<std::uint8_t, 5> kTurned{0, 1, 2, 0, 1};
    const std::int32_t first = mesh.triangleAt[static_cast<std::size_t>(vertex)];
    for (const int turn : {1, 2}) {  // counter-clockwise until it closes or meets the rim, then the other way
        std::int32_t slot = first;
        do {
            const Triangle& triangle = mesh.triangles[static_cast<std::size_t>(slot)];
            const int corner = cornerOf(triangle);
            if (turn == 1 || slot != first) {
                visit(slot, corner);
            }
            slot = triangle.neighbour[kTurned[static_cast<std::size_t>(corner + turn)]];
        } while (slot != kNobody && slot != first);
        if (slot == first) {
            return;
        }
    }
}

}  // namespace sand::tin
