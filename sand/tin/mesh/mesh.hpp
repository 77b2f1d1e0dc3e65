// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "sand/tin/geometry/holes.hpp"
#include "sand/tin/geometry/triangles.hpp"

namespace sand::tin {

/// A constrained Delaunay triangulation of a rectangle whose vertices come, move and go.
///
/// Edges are flipped until none has a vertex in the circle it should be free of (Lawson 1977), by integer predicates.
/// Vertices 0 to 3 are the rectangle's corners, counter-clockwise from the south-west. Where four or more vertices lie
/// on a circle, the diagonals go out from the one that is first in order of Place: the mesh is a function of vertices
/// and constraints alone, whatever came before. Not thread-safe.
class Mesh {
public:
    /// Throws std::invalid_argument unless both sides are within [1, 2^22]. Triangles are told to be holes where
    /// `holes`, which may be null, says so; that is of use once all of their outline is constrained, which is then
    /// there for good: no release() nor remove() takes it out.
    Mesh(std::int32_t width, std::int32_t depth, std::shared_ptr<const Holes> holes = nullptr);
    ~Mesh();
    Mesh(Mesh&&) noexcept;
    Mesh& operator=(Mesh&&) noexcept;

    [[nodiscard]] const Triangles& triangles() const;
    [[nodiscard]] const std::shared_ptr<const Holes>& holes() const;  // null without
    [[nodiscard]] int vertexCount() const;
    /// Whether the whole outline of the holes is there.
    [[nodiscard]] bool hasOutline() const;

    /// The vertex there: a new one, or the one that was there already. Places outside the field: std::invalid_argument.
    /// A place on a constrained edge splits it; both halves are constrained.
    Vertex insert(Place place);
    /// The same for many at once, faster: as if inserted one after the other (numbers are given in this order).
    std::vector<Vertex> insert(std::span<const Place> places);
    /// Room for as many vertices in all, so that none of them makes the whole mesh move in memory.
    void reserve(std::size_t vertices);
    /// Takes a vertex out, with the constraints that end in it. A corner stays, and a vertex on the rim joins its two
    /// rim edges again; so does one on a straight part of a hole's outline. Where that turns or ends it stays. False
    /// when it stays.
    bool remove(Vertex vertex);
    /// A constraint: the vertices along it, both ends included, and which of its edges were constrained before, each
    /// with the smaller vertex first.
    struct Path {
        std::vector<Vertex> vertices;
        std::vector<std::pair<Vertex, Vertex>> before;
    };
    /// Makes every edge between these places constrained, with vertices where it crosses others: a crossing is put on
    /// the nearest lattice place before, or on an end of either within a unit of the other, and both constraints bend
    /// to it; so do others that they come to cross. Vertices on the way split it. Nothing when both are one.
    Path constrain(Vertex from, Vertex to);
    /// The edge between two vertices is an ordinary one again; nothing when it is none, or lies on the rim or on a
    /// hole's outline.
    void release(Vertex a, Vertex b);
    [[nodiscard]] bool isConstrained(Vertex a, Vertex b) const;
    /// All constrained edges but the rim's, smaller vertex first, in order.
    [[nodiscard]] std::vector<std::pair<Vertex, Vertex>> constraints() const;

    /// Takes the ground out of these triangles, which are told to be holes until the mesh changes there.
    void takeGroundOut(std::span<const std::int32_t> slots);

    /// Slots whose triangles are not what they were when this was called last, dead ones among them, and the vertices
    /// that came, went, or have another star: each once, in ascending order.
    struct Change {
        std::vector<std::int32_t> triangles;
        std::vector<Vertex> vertices;
    };
    [[nodiscard]] Change takeChange();
    /// The same for who knows of the vertices; there are none in it.
    [[nodiscard]] Change takeChangeOfTriangles();

    /// A triangle with the places its corners had: counter-clockwise from the smallest vertex.
    struct Piece {
        std::array<Vertex, 3> corner{};
        std::array<Place, 3> place{};
        // clang-tidy 14 complains of the 0 it finds in here itself. NOLINTNEXTLINE(modernize-use-nullptr)
        friend auto operator<=>(const Piece&, const Piece&) = default;
    };
    /// Triangles that were there when this was called last and are no more, and the other way round; by which slots is
    /// no matter. In ascending order; both cover the same ground. Nothing is noted before the first call, which returns
    /// nothing, and takeChange() knows nothing of it.
    struct Difference {
        std::vector<Piece> went, came;
    };
    [[nodiscard]] Difference takeDifference();

    /// Rebuilds a mesh from what makes it one, for replicas that start in the middle: vertices keep their numbers
    /// (`places` by vertex, nothing where no such vertex lives). Throws std::invalid_argument when it is none.
    static Mesh restore(std::int32_t width, std::int32_t depth, std::span<const std::optional<Place>> places,
                        std::span<const std::pair<Vertex, Vertex>> constraints,
                        std::shared_ptr<const Holes> holes = nullptr);

private:
    void requireInside(const Place& place) const;
    void requireAlive(Vertex vertex) const;
    [[nodiscard]] bool isStraight(Vertex vertex, const std::vector<Vertex>& along) const;

    std::unique_ptr<class Triangulation> triangulation_;
};

}  // namespace sand::tin
