// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "sand/tin/geometry/holes.hpp"
#include "sand/tin/mesh/change_record.hpp"

namespace sand::tin {

/// An edge as a side of one of its triangles: the side opposite the corner with index `opposite`.
struct Side {
    std::int32_t slot = kNoNumber;
    std::size_t opposite = 0;
};

constexpr std::size_t next(std::size_t corner) { return corner == 2 ? 0 : corner + 1; }
constexpr std::size_t previous(std::size_t corner) { return corner == 0 ? 2 : corner - 1; }
inline std::size_t cornerOf(const Triangle& triangle, Vertex vertex) {
    return triangle.corner[0] == vertex ? 0 : triangle.corner[1] == vertex ? 1 : 2;
}

/// Returns the corner of the found triangle at which the place lies. Returns 3 if the place is at no vertex.
[[nodiscard]] std::size_t cornerAt(const Located& located);

using VertexPair = std::pair<Vertex, Vertex>;

/// The edge flips that Mesh is made of. Between calls, mustFlip() is false for every unconstrained edge.
class Triangulation {
public:
    Triangulation(std::int32_t width, std::int32_t depth, std::shared_ptr<const Holes> holes);

    [[nodiscard]] const Triangles& mesh() const { return mesh_; }
    [[nodiscard]] const std::shared_ptr<const Holes>& holes() const { return holes_; }
    /// Returns whether a side is an edge of a hole's outline.
    [[nodiscard]] bool isOutline(const Side& side) const;
    /// Returns the neighbours of a vertex along the outline of holes. Edges of the rim do not count.
    [[nodiscard]] std::vector<Vertex> outlineFrom(Vertex vertex) const;
    /// Returns the other end of the constraint that leads from `vertex` straight towards `to` and ends at `to` or
    /// before it. Returns kNoNumber if there is no such constraint.
    [[nodiscard]] Vertex nextAlong(Vertex vertex, const LatticePoint& to) const;
    [[nodiscard]] int vertexCount() const { return vertexCount_; }

    /// Returns the smallest free number. It stays in use until giveBack().
    [[nodiscard]] Vertex takeNumber();
    void giveBack(Vertex number);
    /// Creates all numbers below `count`, in use.
    void reserveNumbers(std::size_t count);
    /// Reserves memory for `vertices` further vertices.
    void reserve(std::size_t vertices);
    /// Returns the vertex at a place within the field. A new vertex gets the number `number`, or a free one if that is
    /// kNoNumber.
    Vertex insert(const LatticePoint& place, Vertex number = kNoNumber) { return insertAt(find(place), place, number); }
    /// Returns the triangle that contains a place. The search begins where the last change was.
    [[nodiscard]] Located find(const LatticePoint& place) { return locate(mesh_, place, last_); }
    /// Returns the ends of the edge on which the place lies. Returns kNoNumber twice if it lies on no edge or at a
    /// vertex.
    [[nodiscard]] VertexPair edgeAt(const Located& located) const;
    Vertex insertAt(const Located& located, const LatticePoint& place, Vertex number);
    /// Removes a vertex, which must not be a corner of the field.
    void remove(Vertex vertex);
    void release(Vertex a, Vertex b);
    /// Marks a triangle as a hole until it changes.
    void makeHole(std::int32_t slot);

    /// The first vertex or constraint on the straight line from one vertex to another.
    struct Hit {
        Vertex vertex = kNoNumber;  // vertex on the line, possibly its end; kNoNumber if the line meets a constraint
        VertexPair edge{};          // the constraint that the line crosses
        std::vector<VertexPair> passed;  // edges that the line crosses before
    };
    [[nodiscard]] Hit follow(Vertex from, Vertex to) const;
    /// Makes the edge from `from` to `hit.vertex`, and constrains it. The hit must be a vertex.
    void carve(Vertex from, const Hit& hit);
    Mesh::Path constrain(Vertex from, Vertex to);

    /// Returns the edge between two vertices. Its slot is kNoNumber if there is no such edge.
    [[nodiscard]] Side findEdge(Vertex a, Vertex b) const;
    [[nodiscard]] bool isConstrained(const Side& side) const { return triangle(side.slot).constrained[side.opposite]; }
    [[nodiscard]] bool onRim(const Side& side) const {
        return triangle(side.slot).neighbour[side.opposite] == kNoNumber;
    }

    /// For Mesh::takeChange() and Mesh::takeDifference(). `noteDifferences` is false before the first
    /// takeDifference().
    ChangeRecord changes;
    ChangeRecord differences;
    bool noteDifferences = false;
    std::size_t mostVertices = std::numeric_limits<std::size_t>::max();  // for Mesh::limitVertices()

private:
    [[nodiscard]] const Triangle& triangle(std::int32_t slot) const {
        return mesh_.triangles[static_cast<std::size_t>(slot)];
    }
    [[nodiscard]] Triangle& triangle(std::int32_t slot) { return mesh_.triangles[static_cast<std::size_t>(slot)]; }
    [[nodiscard]] const LatticePoint& place(Vertex vertex) const {
        return mesh_.places[static_cast<std::size_t>(vertex)];
    }
    [[nodiscard]] std::int64_t area(Vertex a, Vertex b, Vertex c) const {
        return doubledArea(place(a), place(b), place(c));
    }
    /// Calls visit(side) for every triangle around `centre`, until visit() returns true. `side` leads from `centre` to
    /// the next corner counter-clockwise. On the rim, the order of the triangles is unspecified.
    template <class Visit>
    void around(Vertex centre, const Visit& visit) const;
    /// Triangles and neighbours of a vertex, counter-clockwise. others[i] is the corner of slots[i] after the vertex.
    /// On the rim, they run from rim to rim, with one neighbour more than triangles.
    struct Star {
        std::vector<std::int32_t> slots;
        std::vector<Vertex> others;
        [[nodiscard]] bool atRim() const { return slots.size() < others.size(); }
    };
    void findStar(Vertex centre, Star& star) const;
    [[nodiscard]] std::vector<Vertex> link(Vertex centre) const;
    [[nodiscard]] std::pair<Vertex, Vertex> ends(const Side& side) const;
    [[nodiscard]] Side beyond(const Side& side) const;
    [[nodiscard]] bool isWrong(const Side& side) const;

    void touch(std::int32_t slot);
    [[nodiscard]] std::int32_t newSlot();
    void bury(std::int32_t slot);
    struct Outer {
        std::int32_t neighbour;
        bool constrained;
    };
    [[nodiscard]] Outer outer(const Side& side) const;
    /// Makes `slot` the triangle of `corners`, and links its neighbours to it. sides[i] is opposite corners[i].
    void put(std::int32_t slot, const std::array<Vertex, 3>& corners, const std::array<Outer, 3>& sides);
    void setConstrained(const Side& side, bool constrained);

    void flip(const Side& side);
    void split(std::int32_t slot, Vertex vertex);
    void splitSide(const Side& side, Vertex vertex);
    void improveAround(Vertex vertex);
    void improve(std::vector<VertexPair>& suspects);
    [[nodiscard]] bool isConvex(const Side& side) const;
    void releaseAll(Vertex vertex);
    void reduce(Vertex vertex);
    void merge(Vertex vertex);

    std::shared_ptr<const Holes> holes_;  // null if there are none
    Triangles mesh_;
    int vertexCount_ = 4;
    std::vector<std::int32_t> freeSlots_;
    std::vector<Vertex> freeNumbers_;  // heap with the smallest number on top
    // Members that are kept only to reuse their memory:
    std::vector<std::int32_t> stack_;
    std::vector<VertexPair> made_;  // in remove() and release(): edges that may have to be flipped
    Star star_;                     // in remove(); after reduce(), only its `others` are right
    std::vector<Vertex> held_;      // in releaseAll(): neighbours to which constraints lead
    std::int32_t last_ = 0;         // slot near the last change
};

template <class Visit>
void Triangulation::around(Vertex centre, const Visit& visit) const {
    const std::int32_t start = mesh_.triangleAt[static_cast<std::size_t>(centre)];
    for (const int turn : {1, 2}) {
        std::int32_t slot = start;
        do {
            const Triangle& here = triangle(slot);
            const std::size_t corner = cornerOf(here, centre);
            if ((turn == 1 || slot != start) && visit(Side{slot, previous(corner)})) {
                return;
            }
            slot = here.neighbour[turn == 1 ? next(corner) : previous(corner)];
        } while (slot != start && slot != kNoNumber);
        if (slot == start) {
            return;
        }
    }
}

}  // namespace sand::tin
