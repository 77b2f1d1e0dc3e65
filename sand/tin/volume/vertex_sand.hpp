// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "base/byte_stream.hpp"
#include "sand/tin/geometry/tin_start.hpp"
#include "sand/tin/mesh/mesh.hpp"

namespace sand::tin {

struct Remapped;  // sand/tin/volume/remap.hpp

/// All data that make up a VertexSand. They do not depend on its history.
struct VertexSandParts {
    static constexpr LatticePoint kNowhere{-1, -1};  // place of a number without a vertex

    std::int32_t width = 0, depth = 0;                   // size of the field [probe unit]
    std::vector<LatticePoint> places;                    // by vertex
    std::vector<std::int64_t> volumes;                   // by vertex [volume unit]
    std::vector<std::uint8_t> moving;                    // by vertex: 1 if its sand moves, else 0
    std::vector<std::pair<Vertex, Vertex>> constraints;  // in the order of Mesh::constraints()
    std::shared_ptr<const Holes> holes = nullptr;        // from the TinStart; not encoded

    /// Writes the data, not compressed. Equal sand gives equal bytes.
    void encode(base::ByteWriter& writer) const;
};

/// The sand of a TIN: an exact integer volume in every vertex, from which its height follows.
///
/// The surface is linear over each triangle. A third of a triangle's area belongs to each of its vertices. The sum of
/// the volumes is therefore exactly the volume under the surface.
///
/// A vertex's star is the sum of the doubled areas of its triangles [probe unit²]. Its height is volume / star [unit].
/// One volume unit is therefore one height unit (cell size / 2^16) on a sixth of a squared probe unit.
///
/// The |volume| of a vertex stays below 2^62, and its |height| at most 2^32. A height of 2^28 units over a star of 2^34
/// reaches the first limit. add() and setHeight() throw std::overflow_error beyond the first limit. A change of the
/// mesh never exceeds a limit that the sand before was within: the sand of a piece that would exceed it becomes level.
///
/// Triangles in a hole (holes.hpp) are not ground, and count for no star. A vertex that has only such triangles has
/// star 0, no sand and height 0.
///
/// The sand of a vertex moves if some of it flowed in the last sweep. A triangle with such a corner slides at a lower
/// slope than sand at rest. A vertex that a change of the mesh makes moves if one of the vertices of its piece moved.
/// Not thread-safe.
class VertexSand {
public:
    /// Creates sand of height 0. Throws std::invalid_argument unless the mesh has the whole outline of its holes.
    explicit VertexSand(Mesh mesh);

    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    [[nodiscard]] const Triangles& triangles() const { return mesh_.triangles(); }
    [[nodiscard]] const std::vector<std::int64_t>& volumes() const { return volumes_; }  // by vertex [volume unit]
    [[nodiscard]] const std::vector<std::int64_t>& stars() const { return stars_; }      // by vertex [probe unit²]
    /// By vertex [unit]: IEEE quotients volume / star, the same on every machine. Exact if they are integers.
    [[nodiscard]] const std::vector<double>& heights() const { return heights_; }
    /// Returns the height of the linear surface at a place that locate() has found [unit].
    [[nodiscard]] double heightAt(const Located& found) const;
    [[nodiscard]] const std::vector<std::uint8_t>& moving() const { return moving_; }  // by vertex: 1 or 0
    [[nodiscard]] Wide volume() const;
    [[nodiscard]] Wide ground() const;  // sum of all stars [probe unit²]: six times the area
    /// Returns the sum of the magnitudes of all volumes [volume unit]. A change of the mesh never raises it above
    /// kMostSand.
    [[nodiscard]] Wide magnitude() const { return magnitude_; }

    /// Reserves memory for `vertices` vertices in all.
    void reserve(std::size_t vertices);
    /// Limits the number of vertices as Mesh::limitVertices() does.
    void limitVertices(std::size_t most) { mesh_.limitVertices(most); }
    /// Returns whether add() would accept this volume.
    [[nodiscard]] bool hasRoom(Vertex vertex, std::int64_t volume) const;
    /// Adds `volume` to a living vertex; its height follows. Erosion and tools move sand between vertices with this.
    void add(Vertex vertex, std::int64_t volume);
    void setHeight(Vertex vertex, std::int32_t height /* [unit] */);  // of a living vertex; changes the total volume
    void setMoving(Vertex vertex, bool moving) { moving_[static_cast<std::size_t>(vertex)] = moving ? 1 : 0; }
    /// Lets no sand move.
    void stopMoving();

    /// These functions change the mesh as those of Mesh do, and keep the total volume exactly. A new vertex gets the
    /// height of the previous surface there.
    ///
    /// The triangles that change form pieces, each connected through vertices. All vertices of a piece rise or sink by
    /// the same height. It is the volume between the previous surface and the current one, divided by the sum of the
    /// vertices' stars. A remainder that integers cannot share is given out one unit each, in the order of the
    /// vertices' numbers.
    Vertex insert(LatticePoint place);
    bool remove(Vertex vertex);
    std::vector<Vertex> constrain(Vertex from, Vertex to);
    void release(Vertex a, Vertex b);
    /// Makes several changes of the mesh as one, with a single remap when `edits` returns or throws. `edits` must not
    /// call takeChange() or takeDifference(). Returns the vertices on ground that came, went or have another star, in
    /// ascending order.
    std::vector<Vertex> edit(const std::function<void(Mesh&)>& edits);

    /// The largest move of a vertex by a remap since the last call, and the bound for that move [unit]. The move of a
    /// new vertex counts from the previous surface.
    ///
    /// The bound is (h − l) · 3 A / S + 2 / s + 2^-20. For a piece that became level it is infinite. Here h and l are
    /// the highest and the lowest previous height of the piece, and A is its doubled area. S is the sum of its
    /// vertices' stars, and s the smallest of them. The second term covers the rounding of integers, and the third that
    /// of quotients.
    struct Remap {
        double moved = 0, bound = 0;
    };
    [[nodiscard]] Remap takeLargestRemap();
    /// Returns the change as Mesh::takeChange() does, for erosion. It also lists the vertices that a remap has only
    /// raised or lowered.
    [[nodiscard]] Mesh::Change takeChange();

    [[nodiscard]] VertexSandParts parts() const;
    void encode(base::ByteWriter& writer) const { parts().encode(writer); }
    /// Reads what encode() wrote, and no further. Throws base::FormatError if encode() cannot have written the bytes,
    /// if the sand exceeds the limits, or if it does not fit `holes`, which are not among the bytes. Also throws if
    /// there are more than `most` vertices. Allocates memory only for that many.
    static VertexSand decode(base::ByteReader& reader, const std::shared_ptr<const Holes>& holes = nullptr,
                             std::size_t most = kMostNumbers);
    /// Returns the most bytes that encode() writes for `most` vertices.
    [[nodiscard]] static std::uint64_t mostBytes(std::size_t most);
    static constexpr std::size_t kMostNumbers = std::size_t{1} << 30;  // vertices are 32-bit numbers

private:
    void setVolume(Vertex vertex, std::int64_t volume);
    void remap();
    void take(const Remapped& result);

    Mesh mesh_;
    std::vector<std::int64_t> volumes_, stars_;
    std::vector<double> heights_;
    std::vector<std::uint8_t> moving_;
    Wide magnitude_ = 0;
    Remap largest_;
    std::vector<Vertex> remapped_;  // since the last takeChange()
    bool knowsChange_ = false;      // whether takeChange() was called
};

}  // namespace sand::tin
