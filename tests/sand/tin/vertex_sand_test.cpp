// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/volume/vertex_sand.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "tests/sand/tin/mesh_checks.hpp"
#include "tests/support/relaxing.hpp"

namespace vertex_sand {
namespace {

using namespace mesh_checks;
using sand::tin::VertexSand;
using sand::tin::Wide;

void editAtRandom(VertexSand& layer, std::mt19937& random, int most) {
    layer.edit([&](Mesh& mesh) { mesh_checks::editAtRandom(mesh, random, most); });
}

VertexSand layerOf(std::int32_t width, std::int32_t depth, int edits, std::mt19937& random) {
    Mesh mesh(width, depth);
    for (int i = 0; i < edits; ++i) {
        mesh_checks::editAtRandom(mesh, random, edits);
    }
    return VertexSand(std::move(mesh));
}

void pile(VertexSand& layer, std::mt19937& random, std::int32_t range) {
    for (const Vertex vertex : livingVertices(layer.mesh())) {
        layer.setHeight(vertex, static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(2 * range)) - range);
    }
}

/// Expects that over `edits` random edits the volume is exact and no vertex moves beyond the bound.
void editAndWeigh(int edits, std::uint32_t seed) {
    testing::Test::RecordProperty("seed", static_cast<int>(seed));
    std::mt19937 random(seed);
    VertexSand layer = layerOf(4000, 3000, 60, random);
    pile(layer, random, 1 << 24);
    Wide volume = layer.volume();
    for (int i = 0; i < edits; ++i) {
        editAtRandom(layer, random, 80);
        const VertexSand::Remap remap = layer.takeLargestRemap();
        ASSERT_TRUE(layer.volume() == volume) << "seed " << seed << ", edit " << i;
        ASSERT_LE(remap.moved, remap.bound) << "seed " << seed << ", edit " << i;
        if (i % 1000 == 0) {
            pile(layer, random, 1 << 24);
            volume = layer.volume();
        }
    }
}

TEST(VertexSand, KeepsItsVolumeThroughHundredThousandEdits) { editAndWeigh(samples::kSanitized ? 10'000 : 100'000, 2); }

TEST(VertexSand, StaysLevelBitByBit) {
    std::mt19937 random(3);
    VertexSand layer = layerOf(1 << 17, 1 << 17, 40, random);
    for (const Vertex vertex : livingVertices(layer.mesh())) {
        layer.setHeight(vertex, 77'777'777);
    }
    for (int i = 0; i < 2000; ++i) {
        editAtRandom(layer, random, 60);
        for (const Vertex vertex : livingVertices(layer.mesh())) {
            ASSERT_EQ(layer.heights()[static_cast<std::size_t>(vertex)], 77'777'777) << "edit " << i;
        }
    }
}

TEST(VertexSand, KeepsAnInclinedPlaneWithinRounding) {
    std::mt19937 random(4);
    VertexSand layer = layerOf(3000, 2000, 40, random);
    const auto plane = [&layer](Vertex vertex) {
        const Place& place = layer.triangles().places[static_cast<std::size_t>(vertex)];
        return 300 * place.x - 700 * place.y + 12345;
    };
    for (const Vertex vertex : livingVertices(layer.mesh())) {
        layer.setHeight(vertex, plane(vertex));
    }
    for (int i = 0; i < 2000; ++i) {
        editAtRandom(layer, random, 60);
        for (const Vertex vertex : livingVertices(layer.mesh())) {
            // Each remap may round a vertex by two volume units over its star, which is at least three.
            ASSERT_NEAR(layer.heights()[static_cast<std::size_t>(vertex)], plane(vertex), 0.1) << "edit " << i;
        }
    }
}

base::Bytes bytesOf(const VertexSand& layer) {
    base::ByteWriter writer;
    layer.encode(writer);
    return writer.take();
}

TEST(VertexSand, ReadsNoFurtherThanItsEnd) {
    std::mt19937 random(6);
    VertexSand layer = layerOf(500, 400, 60, random);
    pile(layer, random, 1 << 20);
    base::Bytes bytes = bytesOf(layer);
    bytes.push_back(42);
    base::ByteReader reader(bytes);
    const VertexSand again = VertexSand::decode(reader);
    ASSERT_EQ(reader.rest().size(), 1U);
    EXPECT_EQ(again.volumes(), layer.volumes());
    EXPECT_EQ(again.heights(), layer.heights());
    EXPECT_EQ(again.stars(), layer.stars());
    EXPECT_EQ(trianglesOf(again.mesh()), trianglesOf(layer.mesh()));
    EXPECT_EQ(again.mesh().constraints(), layer.mesh().constraints());
}

/// Cuts the bytes after each byte, and changes each byte. Every result must be refused or be a valid layer.
TEST(VertexSand, RefusesDamagedBytesOrReadsAnotherSoundLayer) {
    std::mt19937 random(7);
    VertexSand layer = layerOf(60, 50, 30, random);
    pile(layer, random, 1 << 20);
    const base::Bytes whole = bytesOf(layer);
    int taken = 0, refused = 0;
    const auto tryOn = [&](const base::Bytes& bytes) {
        base::ByteReader reader(bytes);
        try {
            ASSERT_EQ(whatIsWrong(VertexSand::decode(reader).mesh()), "");
            ++taken;
        } catch (const base::FormatError&) {
            ++refused;
        }
    };
    for (std::size_t i = 0; i < whole.size(); ++i) {
        const int before = taken;
        tryOn(base::Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(i)));
        ASSERT_EQ(taken, before) << "cut after " << i;
        for (const int flip : {1, 2, 0x40, 0x80, 0xff}) {
            base::Bytes damaged = whole;
            damaged[i] = static_cast<std::uint8_t>(damaged[i] ^ flip);
            tryOn(damaged);
        }
    }
    EXPECT_GT(taken, 0) << "seed 7";
    EXPECT_GT(refused, static_cast<int>(whole.size())) << "seed 7";
}

TEST(VertexSand, RefusesMoreSandThanItCanCount) {
    VertexSand layer(Mesh(1 << 18, 1 << 18));
    EXPECT_THROW(layer.setHeight(0, 1 << 30), std::overflow_error);
    layer.setHeight(0, 1 << 20);
    EXPECT_THROW(layer.add(0, std::int64_t{1} << 62), std::overflow_error);
}

TEST(VertexSand, IsAFunctionOfTheEditsAndNotOfTheSlots) {
    std::mt19937 random(5);
    VertexSand layer = layerOf(500, 400, 60, random);
    pile(layer, random, 1 << 20);
    const base::Bytes start = bytesOf(layer);
    base::ByteReader reader(start);
    VertexSand restored = VertexSand::decode(reader);
    std::mt19937 same = random;
    for (int i = 0; i < 1000; ++i) {
        editAtRandom(layer, random, 80);
        editAtRandom(restored, same, 80);
        ASSERT_EQ(bytesOf(layer), bytesOf(restored)) << "edit " << i;
    }
}

}  // namespace
}  // namespace vertex_sand
