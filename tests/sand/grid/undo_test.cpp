// SPDX-License-Identifier: Apache-2.0
// An undo restores all cells that were touched, wherever they are among the tiles that it copies.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "sand/grid/snapshot.hpp"
#include "sand/grid/tile_hash.hpp"
#include "sand/replica.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

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

TEST(GridUndo, PutsBackEveryCellOfARectangleThatWasTouched) {
    std::mt19937 random(5);
    const HeightField before = samples::randomField(kColumns, kRows, 1 << 20, random);
    sand::grid::Undo undo;
    undo.keep(before, {}, 0);
    forEachRect([&](const CellRect& cells) {
        HeightField field = before;
        raise(field, cells);
        undo.touch(cells);
        (void)undo.putBackHeights(field);
        ASSERT_TRUE(sameHeights(field, before))
            << cells.x0 << ", " << cells.y0 << " to " << cells.x1 << ", " << cells.y1;
    });
}

TEST(GridUndo, KeepsEveryCellOfARectangleThatWasTouched) {
    std::mt19937 random(6);
    HeightField field = samples::randomField(kColumns, kRows, 1 << 20, random);
    sand::grid::Undo undo;
    undo.keep(field, {}, 0);
    forEachRect([&](const CellRect& cells) {
        raise(field, cells);
        undo.touch(cells);
        undo.keep(field, {}, 0);
        ASSERT_TRUE(sameHeights(undo.kept()->field, field))
            << cells.x0 << ", " << cells.y0 << " to " << cells.x1 << ", " << cells.y1;
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

// Sand that does not slide changes only where the tool touches it. A slide would hide a tile that was not marked,
// because it marks the blocks in which it flows.
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

}  // namespace
}  // namespace grid_undo
