// SPDX-License-Identifier: Apache-2.0
// Corrupted memory of any kind and at any place shows in the hash after one round of the audit.
#include <gtest/gtest.h>

#include <optional>
#include <utility>

#include "sand/grid/erosion.hpp"
#include "sand/replica.hpp"
#include "tests/support/sand_of.hpp"
#include "tests/support/sand_samples.hpp"

namespace audits {

using sand::CellArray;
using sand::grid::Erosion;

// The memory of Erosion is private. A flipped bit does not respect that: an explicit instantiation may name it.
CellArray& eastOf(Erosion& erosion);
CellArray& northOf(Erosion& erosion);
std::optional<CellArray>& slidingOf(Erosion& erosion);
template <auto kEast, auto kNorth, auto kSliding>
struct Memory {
    friend CellArray& eastOf(Erosion& erosion) { return erosion.*kEast; }
    friend CellArray& northOf(Erosion& erosion) { return erosion.*kNorth; }
    friend std::optional<CellArray>& slidingOf(Erosion& erosion) { return erosion.*kSliding; }
};
template struct Memory<&Erosion::east_, &Erosion::north_, &Erosion::sliding_>;

namespace {

using sand::Replica;

constexpr int kColumns = 100, kRows = 70;  // three by two whole tiles of 32 cells, and narrower ones at east and north

/// Returns level sand at rest with a band.
Replica restingSand() {
    scene::Scene scene = samples::flatScene(kColumns, kRows);
    scene.rules.startThreshold = scene.rules.threshold + 1000;
    Replica terrain(scene);
    terrain.apply({1, 1, false, {}});
    return terrain;
}

/// Returns the number of tiles whose hashes differ from those of `right` after one round of the audit.
int spoiltTiles(Replica terrain, const Replica& right, int tile) {
    const std::uint64_t before = terrain.stateHash();
    terrain.audit(terrain.hashTiles().tileCount());
    EXPECT_NE(terrain.stateHash(), before) << "tile " << tile;
    EXPECT_NE(terrain.hashTiles().tileHashes()[static_cast<std::size_t>(tile)],
              right.hashTiles().tileHashes()[static_cast<std::size_t>(tile)]);
    int spoilt = 0;
    for (std::size_t i = 0; i < right.hashTiles().tileHashes().size(); ++i) {
        spoilt += terrain.hashTiles().tileHashes()[i] != right.hashTiles().tileHashes()[i] ? 1 : 0;
    }
    return spoilt;
}

/// Calls corrupt(replica, column, row) for the first and the last cell of every tile. Expects that one round of the
/// audit finds the tile of this cell, and no other tile.
template <class Corrupt>
void expectFound(const Corrupt& corrupt) {
    Replica right = restingSand();
    ASSERT_TRUE(right.settled()) << "the memory of sand that flows is not audited, because the next sweep writes it";
    const std::uint64_t hash = right.stateHash();
    right.audit(right.hashTiles().tileCount());
    ASSERT_EQ(right.stateHash(), hash);
    ASSERT_EQ(right.hashTiles().tileCount(), 12);
    for (int tile = 0; tile < right.hashTiles().tileCount(); ++tile) {
        const sand::CellRect cells = right.hashTiles().cellsOf(tile);
        for (const auto& [column, row] : {std::pair(cells.x0, cells.y0), std::pair(cells.x1 - 1, cells.y1 - 1)}) {
            Replica terrain(restingSand());
            (void)terrain.stateHash();
            corrupt(terrain, column, row);
            EXPECT_EQ(spoiltTiles(std::move(terrain), right, tile), 1) << "tile " << tile;
        }
    }
}

Erosion& memoryOf(Replica& terrain) { return const_cast<Erosion&>(samples::erosionOf(terrain)); }

TEST(Audit, FindsAFlippedBitOfAHeightInEveryTile) {
    expectFound([](Replica& terrain, int column, int row) { terrain.corrupt(column, row, 0); });
}

TEST(Audit, FindsAFluxToTheEastInEveryTile) {
    expectFound([](Replica& terrain, int column, int row) { eastOf(memoryOf(terrain)).row(row)[column] = 1; });
}

TEST(Audit, FindsAFluxToTheNorthInEveryTile) {
    expectFound([](Replica& terrain, int column, int row) { northOf(memoryOf(terrain)).row(row)[column] = 1; });
}

// Sand in a cell with such a mark would slide although it is not steep enough to start.
TEST(Audit, FindsAMarkOfTheBandInEveryTile) {
    expectFound([](Replica& terrain, int column, int row) { slidingOf(memoryOf(terrain))->row(row)[column] = 1; });
}

TEST(Audit, TakesTheTilesInTurn) {
    Replica terrain = restingSand();
    (void)terrain.stateHash();
    terrain.audit(5);
    const std::uint64_t before = terrain.stateHash();
    const sand::CellRect cells = terrain.hashTiles().cellsOf(4);
    terrain.corrupt(cells.x0, cells.y0);
    terrain.audit(11);  // seven up to the last tile, and four from the first
    EXPECT_EQ(terrain.stateHash(), before) << "the fifth tile has been audited";
    terrain.audit(1);
    EXPECT_NE(terrain.stateHash(), before);
}

}  // namespace
}  // namespace audits
