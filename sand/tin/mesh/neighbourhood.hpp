// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/index_set.hpp"
#include "sand/tin/geometry/triangles.hpp"

namespace sand::tin {

/// A rectangle on the lattice, its sides included [probe unit].
struct Box {
    std::int32_t x0 = 0, y0 = 0, x1 = -1, y1 = -1;
    [[nodiscard]] bool empty() const { return x0 > x1 || y0 > y1; }
    [[nodiscard]] bool holds(const Place& place) const {
        return place.x >= x0 && place.x <= x1 && place.y >= y0 && place.y <= y1;
    }
    [[nodiscard]] Box clippedTo(const Triangles& field) const {
        return {std::max(x0, 0), std::max(y0, 0), std::min(x1, field.width), std::min(y1, field.depth)};
    }
    /// The smallest around both; an empty one counts for nothing.
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

/// Sorts numbers from 0 on, each once. Those of one place in a mesh are often near each other: a bit for each is set
/// and read again, in a tenth of the time.
void sortOnce(std::vector<std::int32_t>& numbers);

/// The vertices and triangles of a mesh in a box. Looking costs what lies there and the way from the last box; the
/// first look costs the whole mesh.
class Neighbourhood {
public:
    void reserve(std::size_t vertices) { seen_.reserve(2 * vertices); }
    /// Looks again. `box` is clipped to the field; an empty one shows nothing.
    void look(const Triangles& mesh, const Box& box);
    /// The mesh has changed around these vertices, ascending, and nowhere else: vertices() are those of now, at a
    /// fraction of what it costs to look again. triangles() are none from now on.
    void follow(const Triangles& mesh, const std::vector<Vertex>& changed);

    [[nodiscard]] const Box& box() const { return box_; }  // clipped to the field
    /// Those that lie in the box, ascending.
    [[nodiscard]] const std::vector<Vertex>& vertices() const { return vertices_; }
    /// Slots of all triangles that reach into the box, and of some that nearly do, in no order that means anything.
    [[nodiscard]] const std::vector<std::int32_t>& triangles() const { return triangles_; }

private:
    void fetchAhead(const Triangles& mesh, std::size_t next, std::size_t end) const;

    Box box_;
    std::vector<Vertex> vertices_, stay_, come_;
    std::vector<std::int32_t> triangles_, found_;  // found_: as many as room is for
    std::int32_t last_ = kNobody;                  // where to begin: only for speed
    base::IndexSet seen_;                          // slots
};

/// The vertices around one that lies inside the field, counter-clockwise from the smallest number, and whether any of
/// its edges is constrained.
struct Link {
    std::vector<Vertex> vertices;
    bool constrained = false;
    bool closed = true;  // false on the rim: `vertices` then says nothing
};
void findLink(const Triangles& mesh, Vertex vertex, Link& link);

/// Whether a place is nearer to a segment than `distance` [probe unit]. Exact up to an IEEE product.
[[nodiscard]] bool isNear(const Place& place, const Place& from, const Place& to, std::int32_t distance);

}  // namespace sand::tin
