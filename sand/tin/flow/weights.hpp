// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sand/tin/mesh/mesh.hpp"

namespace sand::tin {

/// What the law of sliding needs to know of a triangle: with d1 = u_1 − u_0 and d2 = u_2 − u_0, the heights of its
/// corners, s = first d1² + mixed d1 d2 + second d2² is the square of its slope over the slope g at which it rests. It
/// slides where s > 1.
struct Facet {
    std::array<Vertex, 3> corner{kNobody, kNobody, kNobody};  // counter-clockwise, the smallest first
    double first = 0, mixed = 0, second = 0;                  // [1/unit²]
    double start = 1;                                         // of s, where sand at rest begins to slide
    /// s.
    [[nodiscard]] double steepness(double d1, double d2) const {
        return first * d1 * d1 + (mixed * d1 + second * d2) * d2;
    }
};

/// And of an edge: of the height that its ends differ by, left · c_left + right · c_right flows, in volume, where c is
/// how strongly each of its triangles slides, from 0 to 1.
struct Edge {
    Vertex from = kNobody, to = kNobody;                     // from < to
    std::int32_t leftFacet = kNobody, rightFacet = kNobody;  // slots; at the rim both are the one there is
    double left = 0, right = 0;  // [probe unit²]; one may be negative, opposite an obtuse angle
};

/// Slopes at which sand slides and starts to [unit per probe unit].
struct Slopes {
    double slide = 0, start = 0;
};

/// One side of a triangle: the edge opposite its corner.
struct TriangleSide {
    std::int32_t triangle = kNobody;  // slot
    int corner = 0;
};

/// The same edge as a side of the triangle beyond; nobody's at the rim, and where a hole is beyond.
[[nodiscard]] TriangleSide across(const Triangles& mesh, TriangleSide side);

/// Where a triangle's smallest corner is.
[[nodiscard]] inline int leastOf(const std::array<Vertex, 3>& corner) {
    // Without a branch: which it is nobody can foretell.
    const int least = corner[1] < corner[0] ? 1 : 0;
    return corner[2] < std::min(corner[0], corner[1]) ? 2 : least;
}

/// The corners of a triangle counter-clockwise from the smallest: however a slot turns them.
[[nodiscard]] std::array<Vertex, 3> smallestFirst(const std::array<Vertex, 3>& corner);

/// How much steeper than its slopes a triangle may be [unit per probe unit]. Heights are told apart by half a unit at
/// best: as much as three heights, each off by that, make it. So a plane of the slope at which sand rests is at rest,
/// and slivers freeze.
[[nodiscard]] double slackOf(const Place& a, const Place& b, const Place& c);

/// The facet of a triangle, with this slack.
[[nodiscard]] Facet facetOf(const Triangles& mesh, std::int32_t slot, const Slopes& slopes);

/// Weights of a mesh's edges, such that sand neither overshoots nor depends on how the mesh is stored.
///
/// An edge's two parts are w · min(step_from, step_to), w being half the cotangent of the opposite angle, and step_i =
/// .9996 star_i / Σ_j w⁺_ij over the edges of vertex i, w⁺ being the sum of an edge's positive parts. What flows over
/// an edge is hence at most k_ij per height, with Σ_j k_ij ≤ step_i Σ_j w⁺_ij = .9996 star_i at either end. Of a
/// triangle whose largest w is beyond kMostWeight all three are smaller by one factor, so that its sand still runs down
/// its slope: with each cut for itself, slivers as steep as three taluses fed on their neighbours for 100,000 sweeps.
/// The w are integers, so that their sum needs no order. Steps and weights are kept until they are forgotten. Not
/// thread-safe.
class Weights {
public:
    void reserve(std::size_t vertices);
    /// The mesh has changed there.
    void forget(const Mesh::Change& change);
    /// The edge of a side on ground and the one across. Costs the stars of its ends, the first time.
    [[nodiscard]] Edge edge(const Triangles& mesh, std::span<const std::int64_t> stars, TriangleSide side,
                            TriangleSide across);

private:
    /// The w of a triangle's angles, times kOne, by its corners as they were when this was the first: a
    /// slot may turn them unnoticed.
    struct Halves {
        Vertex first = kNobody;  // nothing is known
        std::array<std::int32_t, 3> of{};
    };
    [[nodiscard]] const std::array<std::int32_t, 3>& halvesOf(const Triangles& mesh, std::int32_t slot);
    [[nodiscard]] double step(const Triangles& mesh, std::span<const std::int64_t> stars, Vertex vertex);

    std::vector<double> steps_;   // by vertex [probe unit²]; 0: not known
    std::vector<Halves> halves_;  // by slot
};

}  // namespace sand::tin
