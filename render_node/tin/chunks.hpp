// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <vector>

#include "sand/tin/geometry/triangles.hpp"
#include "shapes/model/box.hpp"
#include "shapes/tin/geometry.hpp"

namespace render_node {

/// Triangles that are close together. They are culled together and sent to GL together.
struct TinChunk {
    /// Triangles of a chunk that are closer together, for drawing a small part of a picture: a run of `slots`.
    struct Part {
        std::size_t first, end;
        shapes::Box box;
    };
    std::vector<std::int32_t> slots;  // slots of its triangles
    bool changed = false;             // `slots` has other triangles or is not sorted; see TinChunks::settle()
    bool reshaped = false;            // a triangle has changed its shape since the box was measured
    bool partsReshaped = true;        // a triangle has changed its shape since the parts were measured
    shapes::Box box;
    std::vector<Part> parts;  // made by TinChunks::partsOf()
};

/// Assigns the triangles of a TIN to chunks and parts: squares of the field in which the triangles' middles lie.
///
/// All functions expect the same geometry. Not thread-safe.
class TinChunks {
public:
    /// Returns a side of chunks that suits the number of triangles at the start [probe unit].
    [[nodiscard]] static double sideFor(const sand::tin::Triangles& mesh);
    TinChunks(std::int32_t width, std::int32_t depth /* of the field */, double side /* [probe unit], all */);

    /// Makes room for slots from 0 up to `count`.
    void grow(std::size_t count) { inChunk_.resize(count); }
    /// Replaces a triangle, also in the geometry. The chunk of the new triangle depends on where its corners are now.
    void replace(shapes::TinGeometry& geometry, std::int32_t slot, const shapes::TinTriangle& now);
    /// Moves a triangle to the right chunk and part after its corners have moved. Its corners still have the same
    /// numbers, because a removed vertex's number can be given to a vertex at another place.
    void keepHome(shapes::TinGeometry& geometry, std::int32_t slot);
    /// Says that a triangle has changed its shape. It must be alive.
    void reshape(std::int32_t slot);

    [[nodiscard]] double side() const { return side_; }             // [probe unit]
    [[nodiscard]] std::vector<TinChunk>& all() { return chunks_; }  // row by row from the south-west
    /// Sorts the triangles of a chunk by part and by corners. Returns whether they differ from those at the last call.
    /// The order matters because it is visible where wires cross at a ridge.
    [[nodiscard]] bool settle(const shapes::TinGeometry& geometry, TinChunk& chunk);
    /// Returns the parts of a sorted chunk that have triangles.
    [[nodiscard]] const std::vector<TinChunk::Part>& partsOf(const shapes::TinGeometry& geometry,
                                                             TinChunk& chunk) const;
    /// Returns the box around a chunk that has triangles [scene unit].
    [[nodiscard]] static const shapes::Box& boxOf(const shapes::TinGeometry& geometry, TinChunk& chunk);
    /// Returns a box around `box` and around all chunks above or below it [scene unit].
    [[nodiscard]] shapes::Box withChunksAt(const shapes::TinGeometry& geometry, const shapes::Box& box);

private:
    static constexpr int kPartsAcross = 4;  // parts along a side of a chunk
    struct InChunk {
        int chunk = -1, part = 0, at = 0;
    };
    /// Returns the chunk and the part in which a triangle's middle lies.
    [[nodiscard]] InChunk homeOf(const shapes::TinGeometry& geometry, const shapes::TinTriangle& triangle) const;
    void leaveChunk(std::int32_t slot);

    int across_;                    // chunks
    double side_;                   // [probe unit]
    std::vector<InChunk> inChunk_;  // by slot
    std::vector<TinChunk> chunks_;  // row by row from the south-west
};

}  // namespace render_node
