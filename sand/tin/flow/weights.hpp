// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sand/tin/mesh/mesh.hpp"

namespace sand::tin {

/// The numbers of a triangle in the law of sliding. Let d1 = u_1 − u_0 and d2 = u_2 − u_0 be differences of its
/// corners' heights. Then s = first d1² + mixed d1 d2 + second d2² is the square of its slope over the slope g at
/// which it rests. The triangle slides if s > 1.
struct Facet {
    std::array<Vertex, 3> corner{kNoNumber, kNoNumber, kNoNumber};  // counter-clockwise, the smallest first
    double first = 0, mixed = 0, second = 0;                        // [1/unit²]
    double start = 1;                                               // s at which sand at rest starts to slide
    /// Returns s.
    [[nodiscard]] double steepness(double d1, double d2) const {
        return first * d1 * d1 + (mixed * d1 + second * d2) * d2;
    }
};

/// The numbers of an edge in the law of sliding. Per height difference of its ends, the volume left · c_left + right ·
/// c_right flows. Here c is how strongly each of its triangles slides, from 0 to 1.
struct Edge {
    Vertex from = kNoNumber, to = kNoNumber;                     // from < to
    std::int32_t leftFacet = kNoNumber, rightFacet = kNoNumber;  // slots; equal at the rim
    double left = 0, right = 0;  // [probe unit²]; one may be negative, opposite an obtuse angle
};

/// Slopes above which sliding sand continues and sand at rest starts [unit per probe unit].
struct Slopes {
    double slide = 0, start = 0;
};

/// One side of a triangle: the edge opposite its corner.
struct TriangleSide {
    std::int32_t triangle = kNoNumber;  // slot
    int corner = 0;
};

/// Returns the same edge as a side of the triangle beyond it. Its slot is kNoNumber at the rim and at a hole.
[[nodiscard]] TriangleSide across(const Triangles& mesh, TriangleSide side);

/// Returns the index of a triangle's smallest corner.
[[nodiscard]] inline int leastOf(const std::array<Vertex, 3>& corner) {
    // No branch, because the CPU could not predict it.
    const int least = corner[1] < corner[0] ? 1 : 0;
    return corner[2] < std::min(corner[0], corner[1]) ? 2 : least;
}

/// Returns a triangle's corners counter-clockwise from the smallest, however its slot rotates them.
[[nodiscard]] std::array<Vertex, 3> smallestFirst(const std::array<Vertex, 3>& corner);

/// Returns by how much a triangle may be steeper than its slopes [unit per probe unit]. Heights are accurate to half a
/// unit at best. The slack is the slope that three heights make if each is off by that. A plane with the slope at
/// which sand rests is therefore at rest, and slivers freeze.
[[nodiscard]] double slackOf(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c);

/// Returns the facet of a triangle, with the slack of slackOf().
[[nodiscard]] Facet facetOf(const Triangles& mesh, std::int32_t slot, const Slopes& slopes);

/// Weights of a mesh's edges. They prevent overshooting, and they do not depend on how the mesh is stored.
///
/// An edge's weight has two parts, one of each of its triangles: w times the smallest step of the triangle's corners.
/// Here w is half the cotangent of the opposite angle. step_i is .9996 star_i / Σ_j w⁺_ij over the edges of vertex i,
/// where w⁺ is the sum of an edge's positive parts. The flow over an edge is therefore at most k_ij per height. At both
/// ends, Σ_j k_ij ≤ step_i Σ_j w⁺_ij = .9996 star_i.
///
/// If the largest w of a triangle exceeds kMostWeight, all three are reduced by one factor, so that its sand still
/// runs down its slope. When each was cut by itself, slivers as steep as three taluses took sand from their neighbours
/// for 100,000 sweeps.
///
/// The w are integers, so that the order of their sum does not matter. Steps and weights are kept until forget(). Not
/// thread-safe.
class Weights {
public:
    void reserve(std::size_t vertices);
    /// Forgets steps and weights where the mesh has changed.
    void forget(const Mesh::Change& change);
    /// Returns the edge of a side on ground and of `across`, the same edge in the triangle beyond. The first call
    /// visits all triangles around the corners of both.
    [[nodiscard]] Edge edge(const Triangles& mesh, std::span<const std::int64_t> stars, TriangleSide side,
                            TriangleSide across);

private:
    /// The w of a triangle's angles, times kOne, by corner. They hold while `first` is the first corner, because a
    /// slot may rotate its corners without notice.
    struct Halves {
        Vertex first = kNoNumber;  // kNoNumber: not yet computed
        std::array<std::int32_t, 3> of{};
    };
    [[nodiscard]] const std::array<std::int32_t, 3>& halvesOf(const Triangles& mesh, std::int32_t slot);
    [[nodiscard]] double step(const Triangles& mesh, std::span<const std::int64_t> stars, Vertex vertex);

    std::vector<double> steps_;   // by vertex [probe unit²]; 0: not yet computed
    std::vector<Halves> halves_;  // by slot
};

}  // namespace sand::tin
