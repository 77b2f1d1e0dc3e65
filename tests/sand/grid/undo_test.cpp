// SPDX-License-Identifier: Apache-2.0
// An undo restores all cells that have changed, wherever they are among the tiles that it keeps.
#include "sand/grid/undo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <random>

#include "sand/grid/tile_hash.hpp"
#include "sand/replica.hpp"
#include "tests/support/machine/heap_count.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"
#include "tests/support/seed.hpp"

namespace grid_undo {
namespace {

using sand::CellRect;
using sand::HeightField;
using sand::kProbePerCell;

constexpr int kColumns = 150, kRows = 140;  // three by three tiles of 64 cells, the last ones narrower

/// Calls visit(cells) for rectangles that begin and end beside, at and beyond each border of a tile.
template <class Visit>
void forEachRect(const Visit& visit) {
    constexpr std::array kPlaces{0, 1, 31, 32, 33, 63, 64, 65, 96, 127, 128, 129};
    for (const int from : kPlaces) {
        for (const int end : kPlaces) {
            if (end > from) {
                visit(CellRect{from, 10, end, 20});
                visit(CellRect{10, from, 20, end});
                visit(CellRect{from, from, end, end});
            }
        }
        visit(CellRect{from, from, kColumns, kRows});
    }
}

void raise(HeightField& field, const CellRect& cells) {
    for (int y = cells.y0; y < cells.y1; ++y) {
        for (int x = cells.x0; x < cells.x1; ++x) {
            field.setHeight(x, y, field.height(x, y) + 1);
        }
    }
}

TEST(GridUndo, PutsBackEveryCellOfARectangleThatHasChanged) {
    std::mt19937 random(5);
    const HeightField before = samples::randomField(kColumns, kRows, 1 << 20, random);
    sand::grid::Undo undo;
    undo.keep(before, {}, 0);
    forEachRect([&](const CellRect& cells) {
        HeightField field = before;
        undo.willChange(field, cells);
        raise(field, cells);
        undo.putBackHeights(field);
        ASSERT_TRUE(sameHeights(field, before))
            << cells.x0 << ", " << cells.y0 << " to " << cells.x1 << ", " << cells.y1;
    });
}

// Each rectangle changes on top of the others.
TEST(GridUndo, KeepsEveryCellOfARectangleThatHasChanged) {
    std::mt19937 random(6);
    const HeightField before = samples::randomField(kColumns, kRows, 1 << 20, random);
    HeightField field = before;
    sand::grid::Undo undo;
    undo.keep(field, {}, 0);
    forEachRect([&](const CellRect& cells) {
        undo.willChange(field, cells);
        raise(field, cells);
        base::ByteWriter writer;
        undo.encodeInto(field, writer);
        ASSERT_TRUE(sameHeights(sand::grid::Snapshot::decode(writer.bytes(), {{kColumns, kRows}}).field, before))
            << cells.x0 << ", " << cells.y0 << " to " << cells.x1 << ", " << cells.y1;
    });
    for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
            ASSERT_EQ(undo.height(field, column, row), before.height(column, row)) << column << ", " << row;
        }
    }
}

// A pointer reads many cells of a tile, one after another. Each tile is unpacked once, also when the kept sand changes.
TEST(GridUndo, UnpacksATileForManyCellsOnce) {
    std::mt19937 random(9);
    HeightField field = samples::randomField(kColumns, kRows, 1 << 20, random);
    sand::grid::Undo undo;
    for (int stroke = 0; stroke < 3; ++stroke) {
        const HeightField before = field;
        undo.keep(field, {}, 0);
        undo.willChange(field, field.bounds());
        raise(field, field.bounds());
        for (int x0 = 0; x0 < kColumns; x0 += sand::grid::Undo::kTile) {
            const int x1 = std::min(x0 + sand::grid::Undo::kTile, kColumns);
            ASSERT_EQ(undo.height(field, x0, 0), before.height(x0, 0));
            const long asked = test::heapRequests();
            bool right = true;
            for (int row = 0; row < sand::grid::Undo::kTile; ++row) {
                for (int column = x0; column < x1; ++column) {
                    right = right && undo.height(field, column, row) == before.height(column, row);
                }
            }
            EXPECT_TRUE(right) << stroke;
            EXPECT_EQ(test::heapRequests(), asked) << stroke;
        }
    }
    undo.putBackHeights(field);
    ASSERT_EQ(undo.height(field, 3, 4), field.height(3, 4));
}

TEST(GridUndo, TakesOverSandThatDiffersFromTheField) {
    std::mt19937 random(8);
    const HeightField field = samples::randomField(kColumns, kRows, 1 << 20, random);
    forEachRect([&](const CellRect& cells) {
        HeightField other = field;
        raise(other, cells);
        auto undo = sand::grid::Undo::decode(sand::grid::Snapshot(other, {}, 7).encode(), {{kColumns, kRows}}, field);
        HeightField now = field;
        undo.putBackHeights(now);
        ASSERT_TRUE(sameHeights(now, other));
        ASSERT_EQ(undo.outflow(), 7);
    });
}

TEST(GridHash, TakesEveryCellOfARectangleThatWasTouched) {
    std::mt19937 random(7);
    HeightField field = samples::randomField(kColumns, kRows, 1 << 20, random);
    sand::grid::TileHash hash(field);
    forEachRect([&](const CellRect& cells) {
        raise(field, cells);
        hash.touch(cells);
        int changed = 0;
        hash.update(field, [&](int tile) { changed += hash.cellsOf(tile).clippedTo(cells).empty() ? -99 : 1; });
        ASSERT_GT(changed, 0);
        ASSERT_EQ(hash.sum(), sand::grid::TileHash(field).sum())
            << cells.x0 << ", " << cells.y0 << " to " << cells.x1 << ", " << cells.y1;
    });
}

// Sand that does not slide changes only where the tool touches it. A slide would hide a tile that was not kept, because
// a sweep keeps the blocks that it visits.
TEST(GridUndo, OfAToolAcrossTheBordersOfTilesRestoresSandThatDoesNotSlide) {
    scene::Scene scene = samples::flatScene(kColumns, kRows);
    scene.rules.tuning.threshold = scene.rules.tuning.startThreshold = sand::kLargestThreshold;
    for (const int column : {64, 128}) {
        for (const int row : {64, 128}) {
            for (int beside = -9; beside <= 9; ++beside) {
                sand::Replica replica(scene);
                replica.apply({1, 1, false, {}});
                const sand::ProbePoint probe{(column - beside) * kProbePerCell, (row + beside) * kProbePerCell, 0};
                replica.apply({1, 2, true, {probe}});
                ASSERT_FALSE(sameHeights(samples::fieldOf(replica), scene.terrain));
                replica.apply({1, 3, false, {}, sand::Edit::undo});
                ASSERT_TRUE(sameHeights(samples::fieldOf(replica), scene.terrain))
                    << column << ", " << row << ", " << beside;
            }
        }
    }
}

/// Returns rock with walls and a hollow, all below the sand of a flat scene.
std::shared_ptr<sand::Ground> roughGround() {
    auto ground = std::make_shared<sand::Ground>(kColumns, kRows);
    for (int y = 0; y < kRows; ++y) {
        for (int x = 0; x < kColumns; ++x) {
            ground->setBedrock(x, y, -(2 + (x / 10 + y / 10) % 3) * sand::kUnitsPerCell);
            if (x == 70 && y % 40 > 5) {
                ground->setWall(x, y);
            }
        }
    }
    return ground;
}

// A tile must be kept before the first sweep, drag or edit that changes it, whatever moves its sand.
TEST(GridUndo, ReportsAndKeepsOnlyTheTilesOfTheStroke) {
    sand::Replica replica(samples::flatScene(512, 512));
    const auto step = [&replica](bool engaged) {
        sand::Step next{
            1, replica.stepNumber() + 1, engaged, {{60 * sand::kProbePerCell, 60 * sand::kProbePerCell, 0}}};
        next.sweeps = replica.wholeSweeps(next);
        return next;
    };
    replica.apply(step(true));
    replica.apply(step(false));
    (void)replica.takeChange();
    sand::Step undo = step(false);
    undo.edit = sand::Edit::undo;
    replica.apply(undo);
    ASSERT_EQ(replica.leftOut(), "");
    const sand::SurfaceChange change = replica.takeChange();
    EXPECT_FALSE(change.whole);
    std::int64_t cells = 0;
    for (const sand::CellRect& part : std::get<sand::CellChange>(change.parts).cells) {
        cells += std::int64_t{part.x1 - part.x0} * (part.y1 - part.y0);
    }
    EXPECT_GT(cells, 0);
    EXPECT_LE(cells, 9 * 64 * 64) << "a tile has 64 x 64 cells";
}

TEST(GridUndo, RestoresTheSandOfARandomStroke) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    const auto below = [&random](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
    for (int session = 0; session < 24; ++session) {
        scene::Scene scene = samples::flatScene(kColumns, kRows);
        scene.rules.rim = session % 2 == 0 ? sand::Rim::open : sand::Rim::closed;
        if (session % 3 == 0) {
            scene.ground = roughGround();
        } else {
            scene.terrain = samples::randomField(kColumns, kRows, 6 << 16, random);  // slides from the first step on
        }
        sand::Replica replica(scene);
        sand::ProbePoint probe{below(kColumns * kProbePerCell), below(kRows * kProbePerCell), 0};
        const auto step = [&](bool engaged, const sand::Edit& edit = sand::Edit::none) {
            // A hand that is slow, because a long drag would keep all tiles.
            probe = {probe.x + below(4 * kProbePerCell) - 2 * kProbePerCell,
                     probe.y + below(4 * kProbePerCell) - 2 * kProbePerCell,
                     below(6 * kProbePerCell) - 3 * kProbePerCell};
            replica.apply({0, replica.stepNumber() + 1, engaged, {probe}, edit});
        };
        for (int i = below(20); i >= 0; --i) {
            step(false);
        }
        const HeightField before = samples::fieldOf(replica);
        const std::int64_t outflow = replica.outflow();
        for (int i = below(12); i >= 0; --i) {
            step(true, below(6) == 0 ? sand::Edit::tuned(scene.rules.tuning) : sand::Edit::none);
        }
        step(false, below(3) == 0 ? sand::Edit{sand::Edit::settle} : sand::Edit::none);
        for (int i = below(30); i >= 0; --i) {
            step(false);
        }
        sand::Replica joined(scene);
        joined.decodeState(replica.encodeState());
        for (sand::Replica* one : {&replica, &joined}) {
            ASSERT_TRUE(one->canUndo());
            one->apply({0, one->stepNumber() + 1, false, {}, sand::Edit::undo});
            ASSERT_TRUE(sameHeights(samples::fieldOf(*one), before)) << "session " << session;
            ASSERT_EQ(one->outflow(), outflow) << "session " << session;
        }
    }
}

}  // namespace
}  // namespace grid_undo
