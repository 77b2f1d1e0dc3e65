// SPDX-License-Identifier: Apache-2.0
// A change of the mesh shares out sand that integers cannot share evenly.
#include "sand/tin/volume/remap.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "sand/tin/volume/vertex_sand.hpp"

namespace tin_remap {
namespace {

using sand::tin::Mesh;
using sand::tin::Remapped;
using sand::tin::Vertex;
using sand::tin::VertexSand;
using Volumes = std::vector<std::int64_t>;

constexpr std::int32_t kSide = 2000;  // [probe unit]
constexpr std::int64_t kSquare = std::int64_t{kSide} * kSide;

/// Inserts a vertex into a square of two triangles, in the middle from west to east and a quarter from the south.
/// Returns the volumes of all five vertices. `corner` has had the volume `more`, and all others none.
///
/// The diagonal runs from corner 0 in the south-west to corner 2 in the north-east. Each of these two has a star of two
/// squares. Afterwards there are four triangles around the new vertex. They have a quarter of a square in the south,
/// three quarters in the north, and a half on either side.
Volumes afterInsertion(Vertex corner, std::int64_t more) {
    VertexSand layer{Mesh(kSide, kSide)};
    EXPECT_EQ(layer.stars(), (Volumes{2 * kSquare, kSquare, 2 * kSquare, kSquare}));
    layer.add(corner, more);
    EXPECT_EQ(layer.insert({kSide / 2, kSide / 4}), 4);
    EXPECT_EQ(layer.stars(),
              (Volumes{3 * kSquare / 4, 3 * kSquare / 4, 5 * kSquare / 4, 5 * kSquare / 4, 2 * kSquare}));
    return layer.volumes();
}

TEST(TinRemap, TheRemainderGoesToTheVerticesWithTheSmallestNumbersOneUnitEach) {
    // Corner 0 keeps its height, and with it 3/8 of its volume. The previous surface has half of this height at the new
    // vertex, which gets a half. Four of 32 units are missing. They are 4/6 of a unit per square of the stars. The new
    // vertex gets one of them, and the corners get 0. The other three go to the first three vertices.
    EXPECT_EQ(afterInsertion(0, 32), (Volumes{12 + 1, 1, 1, 0, 16 + 1}));
    // Corner 2 keeps 5/8. The previous surface has a quarter of its height at the new vertex. Four units are missing.
    EXPECT_EQ(afterInsertion(2, 32), (Volumes{1, 1, 20 + 1, 0, 8 + 1}));
    // -4 units are missing. Rounded down they are -1 for each corner and -2 for the new vertex, two units too little.
    EXPECT_EQ(afterInsertion(0, -32), (Volumes{-12 - 1 + 1, -1 + 1, -1, -1, -16 - 2}));
    EXPECT_EQ(afterInsertion(2, -32), (Volumes{-1 + 1, -1 + 1, -20 - 1, -1, -8 - 2}));
}

// A piece whose heights would leave their limits becomes level. 17 units over stars of 1, 2, 1 and 3 are 17 sevenths of
// a unit per star: 2, 4, 2 and 7. The other two go to the first two vertices. The other piece stays.
TEST(TinRemap, TheRemainderOfALevelPieceGoesToItsFirstVertices) {
    Remapped result;
    for (const auto& [vertex, star, volume, piece] : std::array<std::array<int, 4>, 6>{
             {{2, 1, 40, 7}, {3, 9, 5, 8}, {5, 2, -30, 7}, {6, 9, 6, 8}, {8, 1, 0, 7}, {9, 3, 7, 7}}}) {
        result.shares.push_back(
            {.vertex = vertex, .star = star, .volume = volume, .piece = static_cast<std::uint32_t>(piece)});
    }
    sand::tin::levelPieces(result, [](const Remapped::Share& share) { return share.vertex != 5; });
    Volumes volumes;
    for (const Remapped::Share& share : result.shares) {
        volumes.push_back(static_cast<std::int64_t>(share.volume));
    }
    EXPECT_EQ(volumes, (Volumes{3, 5, 5, 6, 2, 7}));
}

}  // namespace
}  // namespace tin_remap
