// SPDX-License-Identifier: Apache-2.0
#include "sand/model/grid_codec.hpp"

#include <zstd.h>

#include <algorithm>
#include <string>

namespace sand {
namespace {

std::size_t countOf(const CellRect& cells) {
    return static_cast<std::size_t>(cells.x1 - cells.x0) * static_cast<std::size_t>(cells.y1 - cells.y0);
}

}  // namespace

void encodeCells(const CellArray& grid, const CellRect& cells, base::ByteWriter& writer) {
    std::vector<std::int32_t> plain;
    plain.reserve(countOf(cells));
    for (int y = cells.y0; y < cells.y1; ++y) {
        plain.insert(plain.end(), grid.row(y) + cells.x0, grid.row(y) + cells.x1);
    }
    const std::size_t size = plain.size() * sizeof plain[0];
    base::Bytes packed(ZSTD_compressBound(size));
    const std::size_t used = ZSTD_compress(packed.data(), packed.size(), plain.data(), size, 1);
    if (ZSTD_isError(used) != 0) {
        throw base::FormatError(std::string("zstd: ") + ZSTD_getErrorName(used));
    }
    packed.resize(used);
    writer.putBlock(packed);
}

void requireCells(base::ByteReader reader, std::size_t cells) {
    // A block of zstd holds 128 KiB at most, and takes four bytes or more.
    constexpr std::size_t kMostPerByte = (std::size_t{1} << 17) / 4;
    if (cells * sizeof(std::int32_t) > reader.getBlock().size() * kMostPerByte) {
        throw base::FormatError("cells that do not unpack to the grid's size");
    }
}

void decodeCells(base::ByteReader& reader, const CellRect& cells, std::int32_t most, CellArray& grid) {
    requireCells(reader, countOf(cells));
    const auto packed = reader.getBlock();
    std::vector<std::int32_t> plain(countOf(cells));
    const std::size_t size = plain.size() * sizeof plain[0];
    if (ZSTD_decompress(plain.data(), size, packed.data(), packed.size()) != size) {
        throw base::FormatError("cells that do not unpack to the grid's size");
    }
    if (std::any_of(plain.begin(), plain.end(), [most](std::int32_t n) { return n > most || n < -most; })) {
        throw base::FormatError("a number out of range in a grid");
    }
    auto next = plain.begin();
    for (int y = cells.y0; y < cells.y1; ++y) {
        std::copy(next, next + (cells.x1 - cells.x0), grid.row(y) + cells.x0);
        next += cells.x1 - cells.x0;
    }
}

}  // namespace sand
