// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "base/byte_stream.hpp"
#include "sand/tin/mesh/mesh.hpp"

namespace sand::tin {

/// Everything that a VertexSand can be made from, independent of its history.
struct VertexSandParts {
    static constexpr Place kNowhere{-1, -1};  // where no such vertex lives

    std::int32_t width = 0, depth = 0;                   // of the field [probe unit]
    std::vector<Place> places;                           // by vertex
    std::vector<std::int64_t> volumes;                   // by vertex
    std::vector<std::pair<Vertex, Vertex>> constraints;  // as Mesh's
    std::shared_ptr<const Holes> holes = nullptr;        // of the start, and not among the bytes

    /// Not compressed; equal sand gives equal bytes.
    void encode(base::ByteWriter& writer) const;
};

/// The sand of a TIN: a volume in every vertex, an exact integer, from which its height follows.
///
/// The surface is linear over each triangle. A vertex's share of the ground is a third of its triangles' area, so that
/// the volumes' sum is the volume under the surface, exactly. One volume unit is a height unit (cell size / 2^16) on a
/// sixth of a squared probe unit: height = volume / star, star being the sum of the doubled areas of the vertex's
/// triangles [probe unit²]. |volume| of one vertex stays below 2^62, which heights of 2^28 reach over a star of 2^34;
/// the whole is summed in 128 bits. Whatever would go beyond throws std::overflow_error, and the layer is then of no
/// use. Triangles in a hole (holes.hpp) are no ground: they count for no star, and a vertex that has no others has
/// neither star nor sand, and lies at 0. Not thread-safe.
class VertexSand {
public:
    /// Throws std::invalid_argument where a hole's outline is not there.
    explicit VertexSand(Mesh mesh);

    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    [[nodiscard]] const Triangles& triangles() const { return mesh_.triangles(); }
    [[nodiscard]] const std::vector<std::int64_t>& volumes() const { return volumes_; }  // by vertex
    [[nodiscard]] const std::vector<std::int64_t>& stars() const { return stars_; }      // by vertex [probe unit²]
    /// By vertex [unit]: IEEE quotients of the two, the same on every machine, exact where they are integers.
    [[nodiscard]] const std::vector<double>& heights() const { return heights_; }
    [[nodiscard]] Wide volume() const;
    [[nodiscard]] Wide ground() const;  // the sum of all stars: six times the area [probe unit²]

    /// As Mesh's.
    void reserve(std::size_t vertices);
    /// Erosion and tools move sand between vertices with this; the height follows.
    void add(Vertex vertex, std::int64_t volume);
    void setHeight(Vertex vertex, std::int32_t height /* [unit] */);  // changes the volume of the whole
    // Both are for living vertices only.

    /// As Mesh's, but that the sand is kept: the volume of the whole is exactly what it was. A new vertex lies on the
    /// surface as it was. Where the mesh changes, all vertices of each piece of what changed rise or sink by one and
    /// the same height, which is the volume between the old surface and the new one over their stars, and what integers
    /// cannot share is dealt out a unit each by number. (A piece: triangles that hang together by vertices.)
    Vertex insert(Place place);
    bool remove(Vertex vertex);
    std::vector<Vertex> constrain(Vertex from, Vertex to);
    void release(Vertex a, Vertex b);
    /// Several of these as one change: one remap over all that they touch when `edits` returns or throws. They leave
    /// takeChange() and takeDifference() alone. Returns the vertices on ground that came, went, or have another star,
    /// ascending.
    std::vector<Vertex> edit(const std::function<void(Mesh&)>& edits);

    /// The most that a vertex was moved by a remap since this was called last, a new one from where the surface was,
    /// and the bound stated for it [unit]: three times the area of the piece that changed, over the sum of its
    /// vertices' stars, of the difference between the highest and the lowest of the piece before; two volume units over
    /// the smallest star for what integers round, and 2^-20 for what quotients do.
    struct Remap {
        double moved = 0, bound = 0;
    };
    [[nodiscard]] Remap takeLargestRemap();
    /// As Mesh's: for whoever erodes it. Vertices that only rose or sank by a remap are among them.
    [[nodiscard]] Mesh::Change takeChange();

    [[nodiscard]] VertexSandParts parts() const;
    void encode(base::ByteWriter& writer) const { parts().encode(writer); }
    /// Throws base::FormatError for bytes that encode() cannot have written, and for sand that does not fit these
    /// holes, which are not among the bytes. Reads no further than its end.
    static VertexSand decode(base::ByteReader& reader, const std::shared_ptr<const Holes>& holes = nullptr);

private:
    void setVolume(Vertex vertex, std::int64_t volume);
    void remap();

    Mesh mesh_;
    std::vector<std::int64_t> volumes_, stars_;
    std::vector<double> heights_;
    Remap largest_;
    std::vector<Vertex> remapped_;  // since takeChange() was called last
    bool knowsChange_ = false;      // takeChange() was called
};

}  // namespace sand::tin
