// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

#include "tests/sand/tin/mesh_checks.hpp"
#include "tests/support/sand/tin_piles.hpp"

/// Sand on meshes of bad shape, its bytes and its energy.
namespace rough_layers {

using sand::tin::Vertex;
using sand::tin::VertexSand;

inline base::Bytes bytesOf(const VertexSand& layer) {
    base::ByteWriter writer;
    layer.encode(writer);
    return writer.bytes();
}

inline VertexSand restored(const VertexSand& layer) {
    const base::Bytes bytes = bytesOf(layer);
    base::ByteReader reader(bytes);
    return VertexSand::decode(reader);
}

inline std::int32_t heightWithin(std::int32_t range, std::mt19937& random) {
    return static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(2 * range)) - range;
}

/// Returns sand of random heights on a mesh that random edits have made. The mesh has slivers, constraints and free
/// numbers.
inline VertexSand roughLayer(std::int32_t side, int edits, std::int32_t range, std::uint32_t seed) {
    testing::Test::RecordProperty("seed", static_cast<int>(seed));
    std::mt19937 random(seed);
    sand::tin::Mesh mesh(side, side);
    for (int i = 0; i < edits; ++i) {
        mesh_checks::editAtRandom(mesh, random, edits);
    }
    VertexSand layer(std::move(mesh));
    for (const Vertex vertex : mesh_checks::livingVertices(layer.mesh())) {
        layer.setHeight(vertex, heightWithin(range, random));
    }
    static_cast<void>(layer.takeChange());
    return layer;
}

/// Returns the sum of V²/star, which falls in every sweep that moves sand.
inline double energyOf(const VertexSand& layer) {
    double sum = 0;
    for (std::size_t i = 0; i < layer.volumes().size(); ++i) {
        sum += layer.triangles().alive(static_cast<Vertex>(i))
                   ? layer.heights()[i] * static_cast<double>(layer.volumes()[i])
                   : 0;
    }
    return sum;
}

}  // namespace rough_layers
