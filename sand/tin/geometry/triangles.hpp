// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sand::tin {

inline constexpr std::int32_t kLatticePerCell = 256;  // equal to sand::kProbePerCell

__extension__ using Wide = __int128;

/// A point of the lattice on which all vertices lie [probe unit = cell size / 256]. The origin is the field's
/// south-west corner; x runs east, y north. The product of two differences of such coordinates is exact in 64 bits.
struct LatticePoint {
    std::int32_t x = 0, y = 0;
    friend bool operator==(const LatticePoint&, const LatticePoint&) = default;
    // clang-tidy 14 reports the 0 in the generated code. NOLINTNEXTLINE(modernize-use-nullptr)
    friend auto operator<=>(const LatticePoint&, const LatticePoint&) = default;
};

/// Returns twice the area of the triangle a, b, c [probe unit²]. It is positive if the corners run counter-clockwise.
/// Exact.
[[nodiscard]] constexpr std::int64_t doubledArea(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c) {
    return std::int64_t{b.x - a.x} * (c.y - a.y) - std::int64_t{b.y - a.y} * (c.x - a.x);
}

/// Number of a vertex. A vertex keeps its number while it lives. A new vertex gets the smallest free number.
using Vertex = std::int32_t;
inline constexpr std::int32_t kNoNumber = -1;  // stands for a missing vertex, triangle or other number

/// Returns `number` as an index of an array.
[[nodiscard]] constexpr std::size_t index(std::int32_t number) { return static_cast<std::size_t>(number); }

/// Triangle with its corners counter-clockwise. neighbour[k] and constrained[k] belong to the edge opposite corner[k].
struct Triangle {
    std::array<Vertex, 3> corner{kNoNumber, kNoNumber, kNoNumber};
    // By slot; kNoNumber across the field's rim.
    std::array<std::int32_t, 3> neighbour{kNoNumber, kNoNumber, kNoNumber};
    std::array<bool, 3> constrained{};  // always true for edges of the rim
    bool hole = false;                  // without ground: cells without data (holes.hpp)
    [[nodiscard]] bool alive() const { return corner[0] != kNoNumber; }
    [[nodiscard]] bool isGround() const { return alive() && !hole; }
};

/// A triangulated field as plain arrays, for drawing, forces and erosion. Some slots are empty.
///
/// The places and the set of triangles depend only on the vertices and the constraints. The slots of triangles and the
/// order of their corners depend on history, so that no state may depend on them.
struct Triangles {
    std::vector<LatticePoint> places;      // by vertex
    std::vector<std::int32_t> triangleAt;  // by vertex: slot of one of its triangles; kNoNumber if there is no vertex
    std::vector<Triangle> triangles;       // by slot
    std::int32_t width = 0, depth = 0;     // size of the field, which begins at (0, 0) [probe unit]
    [[nodiscard]] bool alive(Vertex vertex) const {
        return vertex >= 0 && vertex < static_cast<Vertex>(triangleAt.size()) &&
               triangleAt[static_cast<std::size_t>(vertex)] != kNoNumber;
    }
};

/// Returns whether a place within the field lies on its rim.
[[nodiscard]] constexpr bool isOnRim(const Triangles& mesh, const LatticePoint& place) {
    return place.x == 0 || place.y == 0 || place.x == mesh.width || place.y == mesh.depth;
}

/// The triangle that contains a place, on its edges too.
struct Located {
    std::int32_t triangle = kNoNumber;      // slot
    std::array<std::int64_t, 3> weights{};  // doubled areas opposite the corners [probe unit²]; sum: the triangle's
};

/// Returns the triangle that contains `place`, which is clamped to the field first. Walks there from the triangle
/// `from`, or from any triangle if `from` is kNoNumber. If several triangles share the place, returns the one whose
/// sorted corners come first. The result depends only on mesh and place. The cost is the number of triangles on the
/// way, so start from the last one found.
[[nodiscard]] Located locate(const Triangles& mesh, LatticePoint place, std::int32_t from);

/// Calls visit(slot, corner) for every triangle around a living vertex; `corner` is the index of the vertex in the
/// triangle. The order is counter-clockwise from any triangle, and unspecified on the rim.
template <class Visit>
void aroundVertex(const Triangles& mesh, Vertex vertex, const Visit& visit) {
    const auto cornerOf = [vertex](const Triangle& triangle) {
        // No branch, because the CPU could not predict it.
        return static_cast<int>(triangle.corner[1] == vertex) + 2 * static_cast<int>(triangle.corner[2] == vertex);
    };
    constexpr std::array<std::uint8_t, 5> kTurned{0, 1, 2, 0, 1};
    const std::int32_t first = mesh.triangleAt[static_cast<std::size_t>(vertex)];
    for (const int turn : {1, 2}) {  // counter-clockwise until the circle closes or ends at the rim, then the other way
        std::int32_t slot = first;
        do {
            const Triangle& triangle = mesh.triangles[static_cast<std::size_t>(slot)];
            const int corner = cornerOf(triangle);
            if (turn == 1 || slot != first) {
                visit(slot, corner);
            }
            slot = triangle.neighbour[kTurned[static_cast<std::size_t>(corner + turn)]];
        } while (slot != kNoNumber && slot != first);
        if (slot == first) {
            return;
        }
    }
}

}  // namespace sand::tin
