// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/index_set.hpp"
#include "sand/tin/geometry/triangles.hpp"

namespace sand::tin {

/// Rectangle on the lattice, with its sides [probe unit].
struct Box {
    std::int32_t x0 = 0, y0 = 0, x1 = -1, y1 = -1;
    [[nodiscard]] bool empty() const { return x0 > x1 || y0 > y1; }
    [[nodiscard]] bool holds(const LatticePoint& place) const {
        return place.x >= x0 && place.x <= x1 && place.y >= y0 && place.y <= y1;
    }
    [[nodiscard]] Box clippedTo(const Triangles& field) const {
        return {std::max(x0, 0), std::max(y0, 0), std::min(x1, field.width), std::min(y1, field.depth)};
    }
    /// Returns the smallest box around both boxes. If one is empty, returns the other.
    [[nodiscard]] Box joinedWith(const Box& other) const {
        return empty()         ? other
               : other.empty() ? *this
                               : Box{std::min(x0, other.x0), std::min(y0, other.y0), std::max(x1, other.x1),
                                     std::max(y1, other.y1)};
    }
    [[nodiscard]] Box grownBy(std::int32_t margin) const {
        return {x0 - margin, y0 - margin, x1 + margin, y1 + margin};
    }
    friend bool operator==(const Box&, const Box&) = default;
};

/// Sorts `numbers` in ascending order and removes duplicates. No number may be negative. Numbers from one place of a
/// mesh are often close together. Then the function sets one bit per number and reads the bits, in a tenth of the time
/// of a sort.
void sortOnce(std::vector<std::int32_t>& numbers);

/// The vertices and triangles of a mesh in a box. look() costs as much as the triangles in the box and on the way from
/// the last box. The first call costs as much as the whole mesh.
class Neighbourhood {
public:
    void reserve(std::size_t vertices) { seen_.reserve(2 * vertices); }
    /// Finds the vertices and triangles in `box`, which is clipped to the field. An empty box contains none.
    void look(const Triangles& mesh, const Box& box);
    /// Updates vertices() after the mesh has changed around the vertices `changed` and nowhere else. `changed` must be
    /// in ascending order. This costs a fraction of look(). triangles() is empty until the next look().
    void follow(const Triangles& mesh, const std::vector<Vertex>& changed);

    [[nodiscard]] const Box& box() const { return box_; }  // clipped to the field
    /// Returns the vertices in the box, in ascending order.
    [[nodiscard]] const std::vector<Vertex>& vertices() const { return vertices_; }
    /// Returns the slots of all triangles that reach into the box, and of some close to it. Their order has no
    /// meaning.
    [[nodiscard]] const std::vector<std::int32_t>& triangles() const { return triangles_; }

private:
    void fetchAhead(const Triangles& mesh, std::size_t next, std::size_t end) const;

    Box box_;
    std::vector<Vertex> vertices_, stay_, come_;
    std::vector<std::int32_t> triangles_, found_;  // found_ is longer than the list in it, to save resizing
    std::int32_t last_ = kNoNumber;                // triangle at which the next search begins; saves time only
    base::IndexSet seen_;                          // slots that look() has found
};

/// The neighbours of a vertex, counter-clockwise: from the smallest number, or for a vertex on the rim, from rim to
/// rim.
struct Link {
    std::vector<Vertex> vertices;
    bool constrained = false;  // whether an edge of the vertex is constrained, except for rim and border of holes
    bool bordered = false;     // whether an edge of the vertex is on the border of a hole
    bool closed = true;        // false for a vertex on the rim
};
/// Sets `link` to the neighbours of `vertex`.
void findLink(const Triangles& mesh, Vertex vertex, Link& link);

/// Returns whether the distance of a place from a segment is less than `distance` [probe unit]. Exact except for the
/// rounding of one product of doubles.
[[nodiscard]] bool isNear(const LatticePoint& place, const LatticePoint& from, const LatticePoint& to,
                          std::int32_t distance);

}  // namespace sand::tin
