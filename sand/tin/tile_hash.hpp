// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sand/model/surface.hpp"
#include "sand/tin/snapshot.hpp"

namespace sand::tin {

/// A hash of a TIN's sand that costs only what changed: the sum, modulo 2^64, of one number for every vertex, from its
/// own number, its place and its volume, one for every constraint, and one for the TinState.
///
/// A vertex belongs to the hash tile of its number; the last tile is the constraints' and the state's.
class TileHash final : public HashTiles {
public:
    explicit TileHash(const VertexSand& layer);

    void reserve(std::size_t vertices) {
        byVertex_.reserve(vertices);
        bySlot_.reserve(2 * vertices);
    }
    /// These vertices may have come, gone, or changed.
    void touch(const VertexSand& layer, const std::vector<Vertex>& vertices);
    /// These triangles may have come, gone, or been constrained otherwise, by slot.
    void touchTriangles(const VertexSand& layer, const std::vector<std::int32_t>& slots);
    [[nodiscard]] std::uint64_t update(const TinState& state);
    /// Hashes the next tile again from memory.
    void auditNext(const VertexSand& layer);

    /// Always empty: the vertices of a tile can lie anywhere.
    [[nodiscard]] CellRect cellsOf(int) const override { return {}; }
    [[nodiscard]] static std::vector<std::int32_t> valuesOf(const VertexSand& layer, int tile);

private:
    static constexpr int kTiles = 256;    // of vertices; one more is the constraints'
    static constexpr int kTogether = 64;  // vertices with neighbouring numbers in a tile

    [[nodiscard]] static std::size_t tileOf(Vertex vertex) {
        return static_cast<std::size_t>(vertex / kTogether % kTiles);
    }
    template <class Visit>
    static void forEachOf(const VertexSand& layer, int tile, Visit visit);
    [[nodiscard]] static std::uint64_t hashOf(const VertexSand& layer, Vertex vertex);

    [[nodiscard]] static std::uint64_t constraintsOf(const VertexSand& layer, std::int32_t slot);
    void hashConstraints(const VertexSand& layer);

    std::vector<std::uint64_t> byVertex_;
    std::vector<std::uint64_t> bySlot_;  // of the constraints that a triangle owns
    std::uint64_t constraints_ = 0;
    int nextAudited_ = 0;
};

}  // namespace sand::tin
