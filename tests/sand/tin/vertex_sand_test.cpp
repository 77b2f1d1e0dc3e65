// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/volume/vertex_sand.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/sand/tin/mesh_checks.hpp"
#include "tests/support/sand/relaxing.hpp"

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
        const LatticePoint& place = layer.triangles().places[static_cast<std::size_t>(vertex)];
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

Wide magnitudeOf(const VertexSand& layer) {
    Wide sum = 0;
    for (const std::int64_t volume : layer.volumes()) {
        sum += volume < 0 ? -Wide{volume} : Wide{volume};
    }
    return sum;
}

// Hostile sand may be as rough as 64 bits allow. A remap of rough heights may raise the sum of all magnitudes, which
// must stay within 64 bits, or a single height, which must stay within 2^32.
TEST(VertexSand, OfTheRoughestSandKeepsItsVolumeAndItsLimits) {
    constexpr std::uint32_t kSeed = 8;
    std::mt19937 random(kSeed);
    int level = 0;
    for (const std::int32_t side : {1 << 22, 1 << 8}) {
        VertexSand layer = layerOf(side, side, 60, random);
        for (int round = 0; round < 20; ++round) {
            // The largest height of either sign that the limits allow, in every vertex.
            const Wide most =
                std::min<Wide>((sand::tin::kMostSand - magnitudeOf(layer)) / layer.ground(), Wide{1} << 32);
            for (const Vertex vertex : livingVertices(layer.mesh())) {
                const auto star = layer.stars()[static_cast<std::size_t>(vertex)];
                const auto wanted = static_cast<std::int64_t>(most * star) * (random() % 2 == 0 ? 1 : -1);
                layer.add(vertex, wanted - layer.volumes()[static_cast<std::size_t>(vertex)]);
            }
            ASSERT_TRUE(layer.magnitude() == magnitudeOf(layer));
            const Wide volume = layer.volume();
            for (int i = 0; i < 100; ++i) {
                ASSERT_NO_THROW(editAtRandom(layer, random, 80)) << "seed " << kSeed << ", round " << round;
                ASSERT_TRUE(layer.volume() == volume) << "seed " << kSeed << ", round " << round;
                ASSERT_TRUE(layer.magnitude() == magnitudeOf(layer)) << "seed " << kSeed << ", round " << round;
                ASSERT_TRUE(layer.magnitude() <= sand::tin::kMostSand) << "seed " << kSeed << ", round " << round;
                for (const Vertex vertex : livingVertices(layer.mesh())) {
                    ASSERT_LE(std::abs(layer.heights()[static_cast<std::size_t>(vertex)]), 0x1p32);
                }
                level += std::isinf(layer.takeLargestRemap().bound) ? 1 : 0;
            }
            const base::Bytes bytes = bytesOf(layer);
            base::ByteReader reader(bytes);
            ASSERT_EQ(bytesOf(VertexSand::decode(reader)), bytes) << "it can be decoded";
            for (const Vertex vertex : livingVertices(layer.mesh())) {
                layer.add(vertex, -layer.volumes()[static_cast<std::size_t>(vertex)]);
            }
        }
    }
    EXPECT_GT(level, 0) << "no remap came near a limit";
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
