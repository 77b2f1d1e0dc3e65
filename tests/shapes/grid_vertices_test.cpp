// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "shapes/grid/vertices.hpp"

namespace {

using shapes::GridVertex;
using shapes::GridVertices;
using VertexBits = std::array<std::uint32_t, 4>;

std::vector<GridVertex> allVertices(const GridVertices& surface) {
    const sand::CellRect whole{0, 0, surface.columns() + 2, surface.rows() + 2};
    return surface.verticesIn(whole);
}

TEST(GridVertices, NormalOfAnInclinedPlaneIsThatOfThePlane) {
    sand::HeightField field(9, 7, 0.5);
    for (int row = 0; row < 7; ++row) {
        for (int column = 0; column < 9; ++column) {
            field.setHeight(column, row, column * sand::kUnitsPerCell / 2 - row * sand::kUnitsPerCell / 4);
        }
    }
    const double length = std::sqrt(1 + 0.5 * 0.5 + 0.25 * 0.25);
    for (const GridVertex& vertex : allVertices(GridVertices(field))) {
        EXPECT_NEAR(vertex.normalEast / 32767.0, -0.5 / length, 1e-4);
        EXPECT_NEAR(vertex.normalNorth / 32767.0, 0.25 / length, 1e-4);
    }
}

TEST(GridVertices, LevelGroundSeesTheWholeSkyAndAPitLess) {
    sand::HeightField field(31, 31, 1);
    const std::vector<GridVertex> level = allVertices(GridVertices(field));
    EXPECT_TRUE(std::all_of(level.begin(), level.end(), [](const GridVertex& v) { return v.open == 65535; }));
    field.setHeight(15, 15, -4 * sand::kUnitsPerCell);
    // Each of the eight horizons rises by 4 cells at a distance of 2 cells (2·√2 on the diagonals): sin² = 4/5 and 2/3.
    EXPECT_NEAR(allVertices(GridVertices(field))[16 * 33 + 16].open / 65535.0, 1 - (4 * 0.8 + 4 * 2.0 / 3) / 8, 1e-4);
}

TEST(GridVertices, EdgesOfTheFieldAreCoveredToTheirEnds) {
    const GridVertices surface{sand::HeightField(3, 1, 2)};
    EXPECT_FLOAT_EQ(surface.east(0), 0);
    EXPECT_FLOAT_EQ(surface.east(1), 1);
    EXPECT_FLOAT_EQ(surface.east(4), 6);
    EXPECT_FLOAT_EQ(surface.north(1), 1);
    EXPECT_FLOAT_EQ(surface.north(2), 2);
}

TEST(GridVertices, ACellChangesNoVertexBeyondItsReach) {
    std::mt19937 random(20240611);
    sand::HeightField field(40, 40, 1);
    for (int round = 0; round < 50; ++round) {
        const int x = static_cast<int>(random() % 40U);
        const int y = static_cast<int>(random() % 40U);
        const std::vector<GridVertex> before = allVertices(GridVertices(field));
        field.setHeight(x, y, field.height(x, y) + static_cast<int>(random() % 100000U) - 50000);
        const std::vector<GridVertex> after = allVertices(GridVertices(field));
        for (std::size_t i = 0; i < after.size(); ++i) {
            const int column = static_cast<int>(i % 42) - 1;
            const int row = static_cast<int>(i / 42) - 1;
            if (std::max(std::abs(column - x), std::abs(row - y)) > GridVertices::kReach + 1) {
                ASSERT_EQ(std::bit_cast<VertexBits>(before[i]), std::bit_cast<VertexBits>(after[i]))
                    << "seed 20240611, round " << round << ": cell " << x << "," << y << " changed vertex " << i;
            }
        }
    }
}

/// Some cells of a field, and other heights for a part of them.
sand::CellRect spoil(sand::HeightField& field, std::mt19937& random) {
    const auto below = [&random](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
    const int west = below(field.columns()), south = below(field.rows());
    const sand::CellRect cells{west, south, west + 1 + below(field.columns() - west),
                               south + 1 + below(field.rows() - south)};
    for (int row = cells.y0; row < cells.y1; ++row) {
        for (int column = cells.x0; column < cells.x1; ++column) {
            if (below(8) == 0) {
                field.setHeight(column, row, below(1 << 18) - (1 << 17));
            }
        }
    }
    return cells;
}

// 8 does not divide the sides, so that the blocks at two edges are cut off.
TEST(GridVertices, TakesOverHeightsAndSaysExactlyWhatItOverwrote) {
    std::mt19937 random(20240612);
    sand::HeightField field(45, 29, 1);
    GridVertices surface(field);
    for (int round = 0; round < 200; ++round) {
        const GridVertices before(surface);
        const sand::CellRect cells = spoil(field, random);
        std::vector<GridVertices::Overwritten> overwritten;
        surface.takeOver(field, cells, overwritten);
        std::vector<GridVertices::Overwritten> nothing;
        surface.takeOver(field, field.bounds(), nothing);
        ASSERT_TRUE(nothing.empty()) << "round " << round << ": more has changed than was listed";
        std::vector<int> seen(45 * 29);
        for (const auto& [changed, range] : overwritten) {
            ASSERT_TRUE(changed.x0 / 8 == (changed.x1 - 1) / 8 && changed.y0 / 8 == (changed.y1 - 1) / 8);
            float lowest = 1e9F, highest = -1e9F;
            sand::CellRect exact{45, 29, 0, 0};
            for (int row = changed.y0; row < changed.y1; ++row) {
                for (int column = changed.x0; column < changed.x1; ++column) {
                    seen[static_cast<std::size_t>(row * 45 + column)] = 1;
                    if (const float was = before.height(column, row); was != surface.height(column, row)) {
                        lowest = std::min(lowest, was);
                        highest = std::max(highest, was);
                        exact = {std::min(exact.x0, column), std::min(exact.y0, row), std::max(exact.x1, column + 1),
                                 std::max(exact.y1, row + 1)};
                    }
                }
            }
            ASSERT_EQ(changed, exact) << "round " << round;
            ASSERT_EQ(range.lowest, lowest);
            ASSERT_EQ(range.highest, highest);
        }
        for (int i = 0; i < 45 * 29; ++i) {
            const int column = i % 45, row = i / 45;
            ASSERT_EQ(surface.height(column, row), static_cast<float>(field.height(column, row) * field.unit()));
            ASSERT_TRUE(seen[static_cast<std::size_t>(i)] == 1 ||
                        before.height(column, row) == surface.height(column, row))
                << "round " << round << ": " << column << ", " << row;
        }
    }
}

TEST(GridVertices, HeightsOfAPartAreThoseOfItsCells) {
    std::mt19937 random(20240613);
    sand::HeightField field(45, 29, 1);
    GridVertices surface(field);
    for (int round = 0; round < 300; ++round) {
        std::vector<GridVertices::Overwritten> overwritten;
        surface.takeOver(field, spoil(field, random), overwritten);
        sand::HeightField any(45, 29, 1);
        const sand::CellRect cells = spoil(any, random);
        float lowest = 1e9F, highest = -1e9F;
        for (int row = cells.y0; row < cells.y1; ++row) {
            for (int column = cells.x0; column < cells.x1; ++column) {
                lowest = std::min(lowest, surface.height(column, row));
                highest = std::max(highest, surface.height(column, row));
            }
        }
        const shapes::HeightRange found = surface.heights(cells);
        ASSERT_EQ(found.lowest, lowest) << "round " << round;
        ASSERT_EQ(found.highest, highest) << "round " << round;
    }
}

// A row of 32 blocks, and a field of as many rows.
TEST(GridVertices, ReadsEachListedCellOnceAndLargePartsByTheirBlocks) {
    sand::HeightField field(256, 256, 1);
    GridVertices surface(field);
    std::int64_t before = surface.placesRead();
    std::vector<GridVertices::Overwritten> overwritten;
    surface.takeOver(field, {40, 80, 104, 88}, overwritten);
    EXPECT_EQ(surface.placesRead() - before, 64 * 8);
    before = surface.placesRead();
    (void)surface.heights({39, 79, 105, 89});
    // 8 blocks, the range of the column to their west, and the rest of a ring that is one cell wide.
    EXPECT_EQ(surface.placesRead() - before, 8 + 1 + 2 * 66 + 8);
}

}  // namespace
