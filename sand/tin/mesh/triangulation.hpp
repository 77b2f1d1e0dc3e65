// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "sand/tin/geometry/holes.hpp"
#include "sand/tin/mesh/change_record.hpp"

namespace sand::tin {

/// An edge as the side of one of its triangles that lies opposite the corner of this number.
struct Side {
    std::int32_t slot = kNobody;
    std::size_t opposite = 0;
};

constexpr std::size_t next(std::size_t corner) { return corner == 2 ? 0 : corner + 1; }
constexpr std::size_t previous(std::size_t corner) { return corner == 0 ? 2 : corner - 1; }
inline std::size_t cornerOf(const Triangle& triangle, Vertex vertex) {
    return triangle.corner[0] == vertex ? 0 : triangle.corner[1] == vertex ? 1 : 2;
}

/// The corner whose edges the place lies on both, of what locate() found; 3 when it is no vertex.
[[nodiscard]] std::size_t cornerAt(const Located& located);

using VertexPair = std::pair<Vertex, Vertex>;

/// The flips behind a Mesh. Between calls every edge that is no constraint is as mustFlip() wants it.
class Triangulation {
public:
    Triangulation(std::int32_t width, std::int32_t depth, std::shared_ptr<const Holes> holes);

    [[nodiscard]] const Triangles& mesh() const { return mesh_; }
    [[nodiscard]] const std::shared_ptr<const Holes>& holes() const { return holes_; }
    /// Whether it is an edge of some hole's outline.
    [[nodiscard]] bool isOutline(const Side& side) const;
    /// The vertices next to one along the outline of holes; the rim's edges are none.
    [[nodiscard]] std::vector<Vertex> outlineFrom(Vertex vertex) const;
    /// The other end of the constraint that goes out from a vertex straight to a place, or to a vertex before it;
    /// kNobody when there is none.
    [[nodiscard]] Vertex nextAlong(Vertex vertex, const Place& to) const;
    [[nodiscard]] int vertexCount() const { return vertexCount_; }

    /// The smallest number that no vertex has; it is taken, until giveBack().
    [[nodiscard]] Vertex takeNumber();
    void giveBack(Vertex number);
    /// Numbers up to `count` exist from now on; none of them is free.
    void reserveNumbers(std::size_t count);
    /// For as many more vertices.
    void reserve(std::size_t vertices);
    /// The vertex at a place within the field; where there is none it gets this number, or else takes one.
    Vertex insert(const Place& place, Vertex number = kNobody) { return insertAt(find(place), place, number); }
    /// Where a place lies, found from where something was done last.
    [[nodiscard]] Located find(const Place& place) { return locate(mesh_, place, last_); }
    /// The edge on which it lies, if no vertex is there; two times nobody when it lies on none.
    [[nodiscard]] VertexPair edgeAt(const Located& located) const;
    Vertex insertAt(const Located& located, const Place& place, Vertex number);
    /// Any vertex but a corner of the field.
    void remove(Vertex vertex);
    void release(Vertex a, Vertex b);
    /// Tells a triangle to be a hole until it changes.
    void makeHole(std::int32_t slot);

    /// What a straight way from one vertex to another meets first.
    struct Hit {
        Vertex vertex = kNobody;         // it passes through this one, its end perhaps,
        VertexPair edge{};               // or else crosses this constraint
        std::vector<VertexPair> passed;  // edges it crosses before
    };
    [[nodiscard]] Hit follow(Vertex from, Vertex to) const;
    /// Makes the edge that a way with this hit needs, constrained. The hit must be a vertex.
    void carve(Vertex from, const Hit& hit);
    Mesh::Path constrain(Vertex from, Vertex to);

    /// slot == kNobody when there is no such edge.
    [[nodiscard]] Side findEdge(Vertex a, Vertex b) const;
    [[nodiscard]] bool isConstrained(const Side& side) const { return triangle(side.slot).constrained[side.opposite]; }
    [[nodiscard]] bool onRim(const Side& side) const { return triangle(side.slot).neighbour[side.opposite] == kNobody; }

    /// Of whoever asks for changes, and of whoever asks for differences.
    ChangeRecord changes;
    ChangeRecord differences;
    bool noteDifferences = false;

private:
    [[nodiscard]] const Triangle& triangle(std::int32_t slot) const {
        return mesh_.triangles[static_cast<std::size_t>(slot)];
    }
    [[nodiscard]] Triangle& triangle(std::int32_t slot) { return mesh_.triangles[static_cast<std::size_t>(slot)]; }
    [[nodiscard]] const Place& place(Vertex vertex) const { return mesh_.places[static_cast<std::size_t>(vertex)]; }
    [[nodiscard]] std::int64_t area(Vertex a, Vertex b, Vertex c) const {
        return doubledArea(place(a), place(b), place(c));
    }
    /// Calls visit(side) for the side that goes out from `centre` first, counter-clockwise, of every triangle there,
    /// until it returns true. On the rim too, in no certain order.
    template <class Visit>
    void around(Vertex centre, const Visit& visit) const;
    /// The triangles around a vertex, counter-clockwise, and its neighbours, the first being the first slot's; on the
    /// rim from rim to rim, with one neighbour more.
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
    /// Sides opposite a, b and c, in this order. Neighbours that are alive learn of it.
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

    std::shared_ptr<const Holes> holes_;  // null without
    Triangles mesh_;
    int vertexCount_ = 4;
    std::vector<std::int32_t> freeSlots_;
    std::vector<Vertex> freeNumbers_;  // a heap, the smallest on top
    // Kept for their memory.
    std::vector<std::int32_t> stack_;
    std::vector<VertexPair> made_;  // of remove() and release(): edges that may be wrong
    Star star_;                     // of remove(); after reduce() only its `others` are right
    std::vector<Vertex> held_;      // of releaseAll()
    std::int32_t last_ = 0;         // slot near which something happened last
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
        } while (slot != start && slot != kNobody);
        if (slot == start) {
            return;
        }
    }
}

}  // namespace sand::tin
