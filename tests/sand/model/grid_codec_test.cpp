// SPDX-License-Identifier: Apache-2.0
#include "sand/model/grid_codec.hpp"

#include <gtest/gtest.h>
#include <zstd.h>

#include <random>
#include <span>
#include <stdexcept>
#include <vector>

#include "sand/model/height_field.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using sand::CellArray;

/// Returns a grid whose numbers are up to `range`.
CellArray gridOf(int columns, int rows, std::int32_t range) {
    std::mt19937 random(5);
    return samples::randomField(columns, rows, range, random).cells();
}

bool sameCells(const CellArray& a, const CellArray& b) {
    for (int y = 0; y < a.rows(); ++y) {
        if (!std::equal(a.row(y), a.row(y) + a.columns(), b.row(y))) {
            return false;
        }
    }
    return true;
}

CellArray decoded(std::span<const std::uint8_t> bytes, int columns, int rows, std::int32_t most = sand::kMaxHeight) {
    CellArray grid(columns, rows);
    base::ByteReader reader(bytes);
    sand::decodeCells(reader, grid.bounds(), most, grid);
    EXPECT_TRUE(reader.atEnd());
    return grid;
}

/// Returns a block with frames of zstd, one for each of `parts`.
base::Bytes framesOf(const std::vector<std::vector<std::int32_t>>& parts) {
    base::ByteWriter writer;
    const std::size_t place = writer.beginBlock();
    for (const std::vector<std::int32_t>& part : parts) {
        base::Bytes packed(ZSTD_compressBound(part.size() * sizeof part[0]));
        packed.resize(ZSTD_compress(packed.data(), packed.size(), part.data(), part.size() * sizeof part[0], 3));
        writer.putBytes(packed);
    }
    writer.endBlock(place);
    return writer.take();
}

// The middle one has several stripes, and the last one a stripe of one row.
TEST(GridCodec, ReadsWhatItWrites) {
    for (const auto& [columns, rows] : {std::pair(1, 1), {67, 43}, {1500, 1433}, {(1 << 14), 129}}) {
        const CellArray grid = gridOf(columns, rows, 1 << 20);
        int stripes = 0;
        base::ByteWriter writer;
        sand::encodeCells(grid, grid.bounds(), writer, [&stripes] { ++stripes; });
        EXPECT_EQ(stripes, (std::int64_t{columns} * rows + (1 << 20) - 1) / (1 << 20)) << columns;
        EXPECT_TRUE(sameCells(decoded(writer.bytes(), columns, rows), grid)) << columns;
        EXPECT_EQ(*sand::packedCells(grid, grid.bounds()), writer.bytes());
    }
}

TEST(GridCodec, AlsoReadsOtherDivisionsIntoFrames) {
    for (const auto& parts : {std::vector<std::vector<std::int32_t>>{{1, 2, 3, 4, 5, 6}},
                              {{1}, {2, 3, 4}, {5, 6}},
                              {{1, 2, 3}, {}, {4, 5, 6}, {}}}) {
        const CellArray grid = decoded(framesOf(parts), 3, 2);
        for (int x = 0; x < 3; ++x) {
            EXPECT_EQ(grid.row(0)[x], 1 + x);
            EXPECT_EQ(grid.row(1)[x], 4 + x);
        }
    }
}

TEST(GridCodec, RefusesOtherNumbersOfCellsAndOtherNumbers) {
    EXPECT_THROW((void)decoded(framesOf({{1, 2, 3, 4, 5}}), 3, 2), base::FormatError);
    EXPECT_THROW((void)decoded(framesOf({{1, 2, 3}, {4, 5, 6, 7}}), 3, 2), base::FormatError);
    EXPECT_THROW((void)decoded(framesOf({{1, 2, 3}, {4, 5, 6}, {7}}), 3, 2), base::FormatError);
    EXPECT_THROW((void)decoded(framesOf({{1, 2, 3, 4, 5, 6}}), 3, 2, 5), base::FormatError);
    EXPECT_THROW((void)decoded(framesOf({{1, 2, -6, 4, 5, 3}}), 3, 2, 5), base::FormatError);
}

TEST(GridCodec, RefusesBytesThatAreCutShortOrFollow) {
    const base::Bytes whole = framesOf({{1, 2, 3}, {4, 5, 6}});
    const auto withLength = [](std::span<const std::uint8_t> rest) {
        base::ByteWriter writer;
        writer.putBlock(rest);
        return writer.take();
    };
    const std::span<const std::uint8_t> frames = std::span(whole).subspan(sizeof(std::uint32_t));
    for (std::size_t size = 0; size < frames.size(); ++size) {
        EXPECT_THROW((void)decoded(withLength(frames.first(size)), 3, 2), base::FormatError) << size;
    }
    base::Bytes longer(frames.begin(), frames.end());
    longer.push_back(0);
    EXPECT_THROW((void)decoded(withLength(longer), 3, 2), base::FormatError);
}

TEST(GridCodec, CanBeStoppedBetweenStripes) {
    const CellArray grid(1 << 14, 200);
    base::ByteWriter writer;
    EXPECT_THROW(sand::encodeCells(grid, grid.bounds(), writer, [] { throw std::runtime_error("stop"); }),
                 std::runtime_error);
}

}  // namespace
