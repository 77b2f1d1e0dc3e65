// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "sand/tin/geometry/holes.hpp"
#include "sand/tin/geometry/triangles.hpp"

namespace sand::tin {

/// A constrained Delaunay triangulation of a rectangle. Vertices and constraints can be added and removed.
///
/// Flips edges until the circle around every triangle is empty, as far as constraints allow (Lawson 1977). Integer
/// predicates decide. Vertices 0 to 3 are the rectangle's corners, counter-clockwise from the south-west. If four or
/// more vertices lie on a circle, the diagonals begin at the first of them in the order of LatticePoint. The mesh
/// therefore depends only on vertices and constraints, not on their history. Not thread-safe.
class Mesh {
public:
    /// Throws std::invalid_argument unless both sides are within [1, 2^22] [probe unit]. `holes` may be null.
    /// Triangles are marked as holes where `holes` has no ground. The marks are reliable only once the whole outline
    /// of the holes is constrained. From then on, no release() or remove() takes the outline out.
    Mesh(std::int32_t width, std::int32_t depth, std::shared_ptr<const Holes> holes = nullptr);
    ~Mesh();
    Mesh(Mesh&&) noexcept;
    Mesh& operator=(Mesh&&) noexcept;

    [[nodiscard]] const Triangles& triangles() const;
    [[nodiscard]] const std::shared_ptr<const Holes>& holes() const;  // null if there are none
    [[nodiscard]] int vertexCount() const;
    /// Returns whether the whole outline of the holes is constrained.
    [[nodiscard]] bool hasOutline() const;

    /// Returns the vertex at `place`, and adds one if the place is free. A vertex on a constrained edge splits the
    /// edge; both halves are constrained. Throws std::invalid_argument if `place` lies outside the field.
    Vertex insert(LatticePoint place);
    /// Returns the vertices at many places, as if they were inserted one after the other, but in less time. The
    /// vertices get their numbers in the order of `places`. `done` is called now and then with the part of the places
    /// that is inserted, 0 to 1. It may be empty, and has no effect on the mesh.
    std::vector<Vertex> insert(std::span<const LatticePoint> places,
                               const std::function<void(double share)>& done = {});
    /// Reserves memory for `vertices` vertices in all, so that no insertion up to this number moves the mesh in
    /// memory.
    void reserve(std::size_t vertices);
    /// Limits the mesh to `most` vertices for constrain(). insert() and restore() ignore the limit.
    void limitVertices(std::size_t most);
    /// Removes a vertex and the constraints that end in it. For a vertex on the rim, its two rim edges become one. For
    /// a vertex on a straight part of a hole's outline, its two outline edges become one. The corners of the
    /// field stay. A vertex at which an outline turns or ends stays too. Returns false if the vertex stays.
    bool remove(Vertex vertex);
    /// A constraint: the vertices along it with both ends, and those of its edges that were constrained before. Each
    /// edge lists its smaller vertex first.
    struct Path {
        std::vector<Vertex> vertices;
        std::vector<std::pair<Vertex, Vertex>> before;
    };
    /// Constrains the straight line between two vertices, and returns its path. Vertices on the line split the
    /// constraint.
    ///
    /// At a crossing with another constraint, both get a common vertex. If an end of one constraint is within a unit of
    /// the other, the vertex is this end. Otherwise the vertex is at the lattice place nearest to the crossing. Both
    /// constraints bend to this vertex. Further constraints that they then cross bend in the same way. Returns an empty
    /// path if `from` equals `to`.
    ///
    /// Stops at the first crossing whose vertex would exceed the limit of limitVertices(). Edges of the path from there
    /// on are then not constrained.
    Path constrain(Vertex from, Vertex to);
    /// Makes the edge between two vertices an ordinary one again. Edges of the rim and of a hole's outline stay
    /// constrained. Two vertices without a common edge change nothing.
    void release(Vertex a, Vertex b);
    [[nodiscard]] bool isConstrained(Vertex a, Vertex b) const;
    /// Returns all constrained edges except those of the rim, in ascending order. Each lists its smaller vertex first.
    [[nodiscard]] std::vector<std::pair<Vertex, Vertex>> constraints() const;

    /// Marks these triangles as holes. Each mark stays until the mesh changes there.
    void takeGroundOut(std::span<const std::int32_t> slots);

    /// Slots whose triangles have changed since the last call, and vertices that came, went or have another star.
    /// Slots that have become empty are among them. Each is listed once, in ascending order.
    struct Change {
        std::vector<std::int32_t> triangles;
        std::vector<Vertex> vertices;
    };
    [[nodiscard]] Change takeChange();
    /// Returns the same triangles as takeChange(), but no vertices, in less time.
    [[nodiscard]] Change takeChangeOfTriangles();

    /// A triangle with the places of its corners, counter-clockwise from its smallest vertex.
    struct Piece {
        std::array<Vertex, 3> corner{};
        std::array<LatticePoint, 3> place{};
        friend bool operator==(const Piece&, const Piece&) = default;
        // The library of emscripten has no <=> of arrays.
        friend bool operator<(const Piece& a, const Piece& b) {
            return std::tie(a.corner, a.place) < std::tie(b.corner, b.place);
        }
    };
    /// Triangles that were removed and triangles that were added since the last call, whatever their slots are. Both
    /// lists are in ascending order and cover the same ground. Recording begins with the first call, which returns an
    /// empty Difference. takeChange() and takeDifference() do not affect each other.
    struct Difference {
        std::vector<Piece> removed, added;
    };
    [[nodiscard]] Difference takeDifference();

    /// Creates the mesh with these vertices and constraints, from which a restored replica can continue. `places` is
    /// indexed by vertex; nullopt stands for a vertex that does not exist. Throws std::invalid_argument if places and
    /// constraints do not make a mesh.
    static Mesh restore(std::int32_t width, std::int32_t depth, std::span<const std::optional<LatticePoint>> places,
                        std::span<const std::pair<Vertex, Vertex>> constraints,
                        std::shared_ptr<const Holes> holes = nullptr);

private:
    void requireInside(const LatticePoint& place) const;
    void requireAlive(Vertex vertex) const;
    [[nodiscard]] bool isStraight(Vertex vertex, const std::vector<Vertex>& along) const;

    std::unique_ptr<class Triangulation> triangulation_;
};

}  // namespace sand::tin
