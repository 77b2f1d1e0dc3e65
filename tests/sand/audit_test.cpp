// SPDX-License-Identifier: Apache-2.0
// Corrupted memory of any kind and at any place shows in the hash after one round of the audit.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "sand/grid/erosion.hpp"
#include "sand/replica.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace audits {

using sand::CellArray;
using sand::grid::Erosion;

// The memory of Erosion is private. A flipped bit does not respect that: an explicit instantiation may name it.
CellArray& eastOf(Erosion& erosion);
CellArray& northOf(Erosion& erosion);
template <auto kEast, auto kNorth>
struct Memory {
    friend CellArray& eastOf(Erosion& erosion) { return erosion.*kEast; }
    friend CellArray& northOf(Erosion& erosion) { return erosion.*kNorth; }
};
template struct Memory<&Erosion::east_, &Erosion::north_>;

namespace {

using sand::Replica;

constexpr int kColumns = 100, kRows = 70;  // three by two whole tiles of 32 cells, and narrower ones at east and north

/// Returns level sand at rest with a band.
Replica restingSand() {
    scene::Scene scene = samples::flatScene(kColumns, kRows);
    scene.rules.tuning.startThreshold = scene.rules.tuning.threshold + 1000;
    Replica replica(scene);
    replica.apply({1, 1, false, {}});
    return replica;
}

/// Returns the number of tiles whose hashes differ from those of `right` after one round of the audit.
int spoiltTiles(Replica replica, const Replica& right, int tile) {
    const std::uint64_t before = replica.stateHash();
    replica.audit(replica.hashTiles().tileCount());
    EXPECT_NE(replica.stateHash(), before) << "tile " << tile;
    EXPECT_NE(replica.hashTiles().tileHashes()[static_cast<std::size_t>(tile)],
              right.hashTiles().tileHashes()[static_cast<std::size_t>(tile)]);
    int spoilt = 0;
    for (std::size_t i = 0; i < right.hashTiles().tileHashes().size(); ++i) {
        spoilt += replica.hashTiles().tileHashes()[i] != right.hashTiles().tileHashes()[i] ? 1 : 0;
    }
    return spoilt;
}

/// Calls corrupt(replica, column, row) for the first and the last cell of every tile for which isMeant(cells) is true.
/// Expects that one round of the audit finds the tile of this cell, and no other tile.
template <class Corrupt, class IsMeant>
void expectFoundIn(const IsMeant& isMeant, const Corrupt& corrupt) {
    Replica right = restingSand();
    ASSERT_TRUE(right.settled()) << "the memory of sand that flows is not audited, because the next sweep writes it";
    const std::uint64_t hash = right.stateHash();
    right.audit(right.hashTiles().tileCount());
    ASSERT_EQ(right.stateHash(), hash);
    ASSERT_EQ(right.hashTiles().tileCount(), 12);
    for (int tile = 0; tile < right.hashTiles().tileCount(); ++tile) {
        const sand::CellRect cells = right.hashTiles().cellsOf(tile);
        if (!isMeant(cells)) {
            continue;
        }
        for (const auto& [column, row] : {std::pair(cells.x0, cells.y0), std::pair(cells.x1 - 1, cells.y1 - 1)}) {
            Replica replica(restingSand());
            (void)replica.stateHash();
            corrupt(replica, column, row);
            EXPECT_EQ(spoiltTiles(std::move(replica), right, tile), 1) << "tile " << tile;
        }
    }
}

template <class Corrupt>
void expectFound(const Corrupt& corrupt) {
    expectFoundIn([](const sand::CellRect&) { return true; }, corrupt);
}

Erosion& memoryOf(Replica& replica) { return const_cast<Erosion&>(samples::erosionOf(replica)); }

TEST(Audit, FindsAFlippedBitOfAHeightInEveryTile) {
    expectFound([](Replica& replica, int column, int row) { replica.corrupt(column, row, 0); });
}

TEST(Audit, FindsAFluxToTheEastInEveryTile) {
    expectFound([](Replica& replica, int column, int row) { eastOf(memoryOf(replica)).row(row)[column] = 1; });
}

TEST(Audit, FindsAFluxToTheNorthInEveryTile) {
    expectFound([](Replica& replica, int column, int row) { northOf(memoryOf(replica)).row(row)[column] = 1; });
}

// A cell at the western or southern rim gains what such a flux brings over the rim.
TEST(Audit, FindsAFluxOverTheWesternRimInEveryTileThere) {
    expectFoundIn([](const sand::CellRect& cells) { return cells.x0 == 0; },
                  [](Replica& replica, int, int row) { eastOf(memoryOf(replica)).row(row)[-1] = 1; });
}

TEST(Audit, FindsAFluxOverTheSouthernRimInEveryTileThere) {
    expectFoundIn([](const sand::CellRect& cells) { return cells.y0 == 0; },
                  [](Replica& replica, int column, int) { northOf(memoryOf(replica)).row(-1)[column] = 1; });
}

// An audit must not take sand that falls over an open rim for corrupted memory.
TEST(Audit, LeavesSandThatFallsOverAnOpenRim) {
    scene::Scene scene = samples::flatScene(40, 40);
    scene.rules.rim = sand::Rim::open;
    scene.rules.tuning.sweepsPerStep = 1;
    for (int y = 0; y < 40; ++y) {
        std::fill_n(scene.terrain.row(y), 40, 12 * sand::kUnitsPerCell);
    }
    Replica audited(scene), other(scene);
    int west = 0, south = 0;  // steps after which sand falls there
    do {
        const sand::Step step{1, audited.stepNumber() + 1, false, {}};
        audited.apply(step);
        other.apply(step);
        west += eastOf(memoryOf(audited)).row(20)[-1] != 0 ? 1 : 0;
        south += northOf(memoryOf(audited)).row(-1)[20] != 0 ? 1 : 0;
        audited.audit(audited.hashTiles().tileCount());
        ASSERT_EQ(audited.stateHash(), other.stateHash()) << "step " << step.number;
    } while (!audited.settled() && audited.stepNumber() < 3000);
    EXPECT_TRUE(audited.settled());
    EXPECT_GT(west, 10);
    EXPECT_GT(south, 10);
}

TEST(Audit, TakesTheTilesInTurn) {
    Replica replica = restingSand();
    (void)replica.stateHash();
    replica.audit(5);
    const std::uint64_t before = replica.stateHash();
    const sand::CellRect cells = replica.hashTiles().cellsOf(4);
    replica.corrupt(cells.x0, cells.y0);
    replica.audit(11);  // seven up to the last tile, and four from the first
    EXPECT_EQ(replica.stateHash(), before) << "the fifth tile has been audited";
    replica.audit(1);
    EXPECT_NE(replica.stateHash(), before);
}

}  // namespace
}  // namespace audits
