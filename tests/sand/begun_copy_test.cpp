// SPDX-License-Identifier: Apache-2.0
// A begun copy has the state of its beginning, whatever changes the sand before the copy is complete.
#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <thread>
#include <utility>

#include "sand/grid/packed_cells.hpp"
#include "tests/sand/spread/sessions.hpp"
#include "tests/support/sand/tin_scene.hpp"
#include "tests/support/seed.hpp"

namespace begun_copy {
namespace {

using sand::CellArray;
using sand::CellRect;
using sand::Replica;
using sand::grid::PackedCells;

constexpr int kColumns = 150, kRows = 140;  // three by three tiles, the last ones narrower

/// Returns steep sand, with rock and walls in every second scene.
scene::Scene sceneOf(unsigned seed) {
    std::mt19937 random(seed);
    scene::Scene scene = samples::flatScene(kColumns, kRows);
    scene.rules.rim = seed % 3 == 0 ? sand::Rim::open : sand::Rim::closed;
    scene.terrain = samples::randomField(kColumns, kRows, 6 << 16, random);
    if (seed % 2 == 0) {
        auto ground = std::make_shared<sand::Ground>(kColumns, kRows);
        for (int y = 0; y < kRows; ++y) {
            for (int x = 0; x < kColumns; ++x) {
                ground->setBedrock(x, y, -10 * sand::kUnitsPerCell);
            }
            ground->setWall(70, y);
        }
        scene.ground = std::move(ground);
    }
    return scene;
}

/// Applies random steps between the beginning of a copy and its end. Each has at most `cells` cells copied after it.
void expectStateOfTheBeginning(Replica& replica, std::mt19937& random, std::uint32_t cells) {
    const Replica saved = replica;
    for (int i = 0; i < 30; ++i) {
        const base::Bytes wanted = replica.encodeState();
        const sand::StateCopy copy = replica.beginCopy();
        for (unsigned steps = random() % 4; steps > 0; --steps) {
            sand::Step step = spread::randomStep(replica.rules(), saved, random);
            step.number = replica.stepNumber() + 1;
            step.sweeps = std::min(5, replica.mostSweeps(step));
            replica.apply(step);
            if (random() % 8 == 0) {
                replica.corrupt(static_cast<int>(random() % kColumns), static_cast<int>(random() % kRows));
            }
            if (cells > 0) {
                (void)replica.continueCopy(random() % cells);
            }
        }
        while (replica.continueCopy(5000)) {
        }
        ASSERT_TRUE(copy.complete());
        ASSERT_TRUE(copy.encode() == wanted) << "copy " << i;
    }
}

TEST(BegunCopy, HasTheStateOfItsBeginning) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    for (unsigned session = 0; session < 6; ++session) {
        SCOPED_TRACE(session);
        std::mt19937 random(seed + session);
        Replica replica(sceneOf(session));
        ASSERT_NO_FATAL_FAILURE(expectStateOfTheBeginning(replica, random, session < 3 ? 0 : 9000));
    }
}

TEST(BegunCopy, OfATinIsCompleteAtOnce) {
    Replica replica(samples::tinScene());
    const base::Bytes wanted = replica.encodeState();
    const sand::StateCopy copy = replica.beginCopy();
    EXPECT_TRUE(copy.complete());
    EXPECT_FALSE(replica.continueCopy(1));
    replica.apply({1, 1, true, {{10 * sand::kProbePerCell, 8 * sand::kProbePerCell, 0}}});
    EXPECT_EQ(copy.encode(), wanted);
}

// Each call copies at least one tile.
TEST(BegunCopy, OfSandAtRestIsMadeTileByTile) {
    Replica replica(samples::flatScene(kColumns, kRows));
    const sand::StateCopy copy = replica.beginCopy();
    for (int tile = 0; tile < 9; ++tile) {
        EXPECT_FALSE(copy.complete()) << tile;
        EXPECT_TRUE(replica.continueCopy(1)) << tile;
    }
    EXPECT_TRUE(copy.complete());
    EXPECT_FALSE(replica.continueCopy(1));
}

TEST(BegunCopy, IsLostWithItsReplica) {
    Replica replica(sceneOf(1));
    const sand::StateCopy lost = replica.beginCopy();
    replica = Replica(sceneOf(2));
    EXPECT_FALSE(replica.continueCopy(1));
    EXPECT_FALSE(lost.complete());
    // A copy of a replica completes no copy that the replica has begun.
    const sand::StateCopy copy = replica.beginCopy();
    Replica other = replica;
    EXPECT_FALSE(other.continueCopy(1));
    EXPECT_TRUE(replica.continueCopy(kColumns * kRows));
    EXPECT_TRUE(copy.complete());
}

// As the master does for its checkpoints. ThreadSanitizer sees if the thread reads what steps change.
TEST(BegunCopy, IsReadByAThreadWhileTheSandChanges) {
    std::mt19937 random(3);
    Replica replica(sceneOf(4));
    const Replica saved = replica;
    for (int i = 0; i < 5; ++i) {
        const base::Bytes wanted = replica.encodeState();
        auto copy = std::make_unique<const sand::StateCopy>(replica.beginCopy());
        const auto step = [&] {
            sand::Step next = spread::randomStep(replica.rules(), saved, random);
            next.number = replica.stepNumber() + 1;
            replica.apply(next);
        };
        step();
        (void)replica.continueCopy(kColumns * kRows);
        ASSERT_TRUE(copy->complete());
        base::Bytes bytes;
        std::thread thread([copy = std::move(copy), &bytes] { bytes = copy->encode(); });
        for (int n = 0; n < 10; ++n) {
            step();
        }
        thread.join();
        ASSERT_TRUE(bytes == wanted) << i;
    }
}

/// Returns a grid with numbers of one of five sizes, ghost cells included.
CellArray gridOf(int columns, int rows, unsigned size, std::mt19937& random) {
    CellArray grid(columns, rows);
    for (int y = -1; y <= rows; ++y) {
        for (int x = -1; x <= columns; ++x) {
            const auto number = static_cast<std::int32_t>(random());
            const std::int32_t small = number % 7;
            grid.row(y)[x] = size == 0   ? 0
                             : size == 1 ? number
                             : size == 2 ? small
                             : size == 3 ? sand::kMaxHeight + small
                                         : 44'000 * x - 30'000 * y + small;
        }
    }
    return grid;
}

TEST(PackedCells, HaveTheNumbersOfEveryRectangle) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    const auto below = [&random](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
    for (unsigned i = 0; i < 600; ++i) {
        const int columns = 1 + below(90), rows = 1 + below(90);
        const CellArray grid = gridOf(columns, rows, i % 5, random);
        CellRect cells{below(columns + 1) - 1, below(rows + 1) - 1, 0, 0};
        cells.x1 = cells.x0 + 1 + below(columns - cells.x0);
        cells.y1 = cells.y0 + 1 + below(rows - cells.y0);
        const PackedCells packed(grid, cells);
        CellArray again(columns, rows);
        packed.putInto(again);
        const std::vector<std::int32_t> numbers = packed.numbers();
        std::size_t next = 0;
        for (int y = -1; y <= rows; ++y) {
            for (int x = -1; x <= columns; ++x) {
                const bool inside = x >= cells.x0 && x < cells.x1 && y >= cells.y0 && y < cells.y1;
                ASSERT_EQ(again.row(y)[x], inside ? grid.row(y)[x] : 0) << i << ": " << x << ", " << y;
                ASSERT_TRUE(!inside || numbers.at(next++) == grid.row(y)[x]) << i << ": " << x << ", " << y;
            }
        }
        ASSERT_EQ(next, numbers.size());
        if (i % 5 == 0) {
            ASSERT_TRUE(packed.isZero());
        }
    }
}

}  // namespace
}  // namespace begun_copy
