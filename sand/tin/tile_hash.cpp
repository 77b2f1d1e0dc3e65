// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/tile_hash.hpp"

#include <xxhash.h>

#include <algorithm>
#include <numeric>

namespace sand::tin {
namespace {

/// Combines `before` and `value` with the finaliser of MurmurHash3. Every bit of both reaches every bit of the result.
std::uint64_t mixed(std::uint64_t before, std::uint64_t value) {
    value ^= before * 0x9e3779b97f4a7c15ULL;
    value = (value ^ (value >> 33)) * 0xff51afd7ed558ccdULL;
    value = (value ^ (value >> 33)) * 0xc4ceb9fe1a85ec53ULL;
    return value ^ (value >> 33);
}

std::uint64_t together(std::int32_t high, std::int32_t low) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(high)) << 32 | static_cast<std::uint32_t>(low);
}

}  // namespace

TileHash::TileHash(const VertexSand& layer) {
    hashes_.assign(kTiles + 1, 0);
    std::vector<Vertex> all(layer.triangles().triangleAt.size());
    std::iota(all.begin(), all.end(), 0);
    touch(layer, all);
    hashConstraints(layer);
}

std::uint64_t TileHash::hashOf(const VertexSand& layer, Vertex vertex) {
    if (!layer.triangles().alive(vertex)) {
        return 0;
    }
    const auto i = static_cast<std::size_t>(vertex);
    const LatticePoint place = layer.triangles().places[i];
    const std::uint64_t hash = mixed(mixed(mixed(1, static_cast<std::uint64_t>(vertex)), together(place.x, place.y)),
                                     static_cast<std::uint64_t>(layer.volumes()[i]));
    return layer.moving()[i] != 0 ? mixed(hash, 1) : hash;
}

void TileHash::touch(const VertexSand& layer, const std::vector<Vertex>& vertices) {
    byVertex_.resize(std::max(byVertex_.size(), layer.triangles().triangleAt.size()), 0);
    for (const Vertex vertex : vertices) {
        const std::uint64_t now = hashOf(layer, vertex);
        std::uint64_t& before = byVertex_[static_cast<std::size_t>(vertex)];
        hashes_[tileOf(vertex)] += now - before;
        before = now;
    }
}

/// A constraint belongs to the triangle in which it runs from its smaller vertex to the larger.
std::uint64_t TileHash::constraintsOf(const VertexSand& layer, std::int32_t slot) {
    const Triangle& triangle = layer.triangles().triangles[static_cast<std::size_t>(slot)];
    std::uint64_t sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vertex a = triangle.corner[(k + 1) % 3], b = triangle.corner[(k + 2) % 3];
        if (a < b && triangle.constrained[k] && triangle.neighbour[k] != kNoNumber) {
            sum += mixed(2, together(a, b));
        }
    }
    return sum;
}

void TileHash::touchTriangles(const VertexSand& layer, const std::vector<std::int32_t>& slots) {
    bySlot_.resize(std::max(bySlot_.size(), layer.triangles().triangles.size()), 0);
    for (const std::int32_t slot : slots) {
        const std::uint64_t now = constraintsOf(layer, slot);
        std::uint64_t& before = bySlot_[static_cast<std::size_t>(slot)];
        constraints_ += now - before;
        before = now;
    }
}

void TileHash::hashConstraints(const VertexSand& layer) {
    bySlot_.assign(layer.triangles().triangles.size(), 0);
    constraints_ = 0;
    for (std::size_t slot = 0; slot < bySlot_.size(); ++slot) {
        constraints_ += bySlot_[slot] = constraintsOf(layer, static_cast<std::int32_t>(slot));
    }
}

std::uint64_t TileHash::update(const TinState& state) {
    base::ByteWriter writer;
    state.encode(writer);
    hashes_.back() = constraints_ + XXH3_64bits(writer.bytes().data(), writer.bytes().size());
    return std::accumulate(hashes_.begin(), hashes_.end(), std::uint64_t{0});
}

template <class Visit>
void TileHash::forEachOf(const VertexSand& layer, int tile, Visit visit) {
    const auto count = static_cast<Vertex>(layer.triangles().triangleAt.size());
    for (Vertex first = tile * kTogether; first < count; first += kTogether * kTiles) {
        for (Vertex vertex = first; vertex < std::min(count, first + kTogether); ++vertex) {
            visit(vertex);
        }
    }
}

void TileHash::auditNext(const VertexSand& layer) {
    const int tile = nextAudited_;
    nextAudited_ = (nextAudited_ + 1) % (kTiles + 1);
    if (tile == kTiles) {
        hashConstraints(layer);
        return;
    }
    byVertex_.resize(std::max(byVertex_.size(), layer.triangles().triangleAt.size()), 0);
    std::uint64_t sum = 0;
    forEachOf(layer, tile, [&](Vertex vertex) {
        byVertex_[static_cast<std::size_t>(vertex)] = hashOf(layer, vertex);
        sum += byVertex_[static_cast<std::size_t>(vertex)];
    });
    hashes_[static_cast<std::size_t>(tile)] = sum;
}

std::vector<std::int32_t> TileHash::valuesOf(const VertexSand& layer, int tile) {
    std::vector<std::int32_t> values;
    if (tile == kTiles) {
        for (const auto& [a, b] : layer.mesh().constraints()) {
            values.insert(values.end(), {a, b});
        }
        return values;
    }
    forEachOf(layer, tile, [&](Vertex vertex) {
        const auto i = static_cast<std::size_t>(vertex);
        const bool alive = layer.triangles().alive(vertex);
        const LatticePoint place = alive ? layer.triangles().places[i] : LatticePoint{-1, -1};
        const auto volume = static_cast<std::uint64_t>(alive ? layer.volumes()[i] : 0);
        values.insert(values.end(), {place.x, place.y, static_cast<std::int32_t>(volume >> 32),
                                     static_cast<std::int32_t>(volume & 0xffffffffU), alive ? layer.moving()[i] : 0});
    });
    return values;
}

}  // namespace sand::tin
