// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sand/model/surface.hpp"
#include "sand/tin/snapshot.hpp"

namespace sand::tin {

/// Hash of a TIN's sand. An update costs only as much as has changed. The hash is a sum modulo 2^64 of one number per
/// vertex, one per constraint, and one for the TinState. A vertex's number depends on the vertex, its place, its volume
/// and whether its sand moves.
///
/// The number of a vertex selects its hash tile. The last tile contains the constraints and the TinState.
class TileHash final : public HashTiles {
public:
    explicit TileHash(const VertexSand& layer);

    void reserve(std::size_t vertices) {
        byVertex_.reserve(vertices);
        bySlot_.reserve(2 * vertices);
    }
    /// Hashes these vertices again, which may have come, gone or changed.
    void touch(const VertexSand& layer, const std::vector<Vertex>& vertices);
    /// Hashes the constraints of these slots again. Their triangles may have come, gone, or changed their constraints.
    void touchTriangles(const VertexSand& layer, const std::vector<std::int32_t>& slots);
    [[nodiscard]] std::uint64_t update(const TinState& state);
    /// Hashes the next tile again from memory.
    void auditNext(const VertexSand& layer);

    /// Returns an empty rectangle, because the vertices of a tile can lie anywhere.
    [[nodiscard]] CellRect cellsOf(int) const override { return {}; }
    [[nodiscard]] static std::vector<std::int32_t> valuesOf(const VertexSand& layer, int tile);

private:
    static constexpr int kTiles = 256;    // of vertices; one more tile has the constraints and the TinState
    static constexpr int kTogether = 64;  // vertices with consecutive numbers in a tile

    [[nodiscard]] static std::size_t tileOf(Vertex vertex) {
        return static_cast<std::size_t>(vertex / kTogether % kTiles);
    }
    template <class Visit>
    static void forEachOf(const VertexSand& layer, int tile, Visit visit);
    [[nodiscard]] static std::uint64_t hashOf(const VertexSand& layer, Vertex vertex);

    [[nodiscard]] static std::uint64_t constraintsOf(const VertexSand& layer, std::int32_t slot);
    void hashConstraints(const VertexSand& layer);

    std::vector<std::uint64_t> byVertex_;
    std::vector<std::uint64_t> bySlot_;  // hash of the constraints that belong to each slot
    std::uint64_t constraints_ = 0;
    int nextAudited_ = 0;
};

}  // namespace sand::tin
