// SPDX-License-Identifier: Apache-2.0
#include "sand/model/grid_codec.hpp"

#include <zstd.h>

#include <algorithm>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace sand {
namespace {

constexpr int kMostWindow = 23;  // log2 of the memory that a frame may need to be unpacked [byte]

std::size_t countOf(const CellRect& cells) {
    return static_cast<std::size_t>(cells.x1 - cells.x0) * static_cast<std::size_t>(cells.y1 - cells.y0);
}

/// Appends a frame with the numbers of `plain`.
void appendFrame(const std::vector<std::int32_t>& plain, base::Bytes& packed, base::ByteWriter& writer) {
    const std::size_t size = plain.size() * sizeof plain[0];
    packed.resize(ZSTD_compressBound(size));
    const std::size_t used = ZSTD_compress(packed.data(), packed.size(), plain.data(), size, 1);
    if (ZSTD_isError(used) != 0) {
        throw base::FormatError(std::string("zstd: ") + ZSTD_getErrorName(used));
    }
    writer.putBytes(std::span(packed).first(used));
}

/// Unpacks frames of zstd, one after the other.
class Unpacker {
public:
    explicit Unpacker(std::span<const std::uint8_t> packed)
        : context_(ZSTD_createDCtx(), ZSTD_freeDCtx), in_{packed.data(), packed.size(), 0} {
        if (context_ == nullptr) {
            throw std::bad_alloc();
        }
        (void)ZSTD_DCtx_setParameter(context_.get(), ZSTD_d_windowLogMax, kMostWindow);
    }

    /// Reads the next `count` numbers.
    void read(std::int32_t* numbers, std::size_t count) {
        ZSTD_outBuffer out{numbers, count * sizeof *numbers, 0};
        while (out.pos < out.size) {
            step(out);
        }
    }
    /// Returns the number of packed bytes that were read.
    [[nodiscard]] std::size_t bytes() const { return in_.pos; }
    /// Throws unless the last frame ends here.
    void finish() {
        std::uint8_t further = 0;
        while (inFrame_ || in_.pos < in_.size) {
            ZSTD_outBuffer out{&further, 1, 0};
            step(out);
            if (out.pos > 0) {
                refuse();
            }
        }
    }

private:
    [[noreturn]] static void refuse() { throw base::FormatError("cells that do not unpack to the grid's size"); }

    void step(ZSTD_outBuffer& out) {
        const std::size_t inBefore = in_.pos, outBefore = out.pos;
        const std::size_t left = ZSTD_decompressStream(context_.get(), &out, &in_);
        if (ZSTD_isError(left) != 0 || (in_.pos == inBefore && out.pos == outBefore)) {
            refuse();
        }
        inFrame_ = left != 0;
    }

    std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> context_;
    ZSTD_inBuffer in_;
    bool inFrame_ = true;
};

}  // namespace

void encodeCells(const CellArray& grid, const CellRect& cells, base::ByteWriter& writer,
                 const std::function<void()>& between) {
    encodeRows(
        cells, [&grid](int row) { return grid.row(row); }, writer, between);
}

void encodeRows(const CellRect& cells, const std::function<const std::int32_t*(int row)>& rowOf,
                base::ByteWriter& writer, const std::function<void()>& between) {
    const auto across = static_cast<std::size_t>(cells.x1 - cells.x0);
    const std::uint64_t place = writer.beginBlock();
    std::vector<std::int32_t> plain;
    plain.reserve(std::min(countOf(cells), kStripe + across));
    base::Bytes packed;
    for (int y = cells.y0; y < cells.y1; ++y) {
        const std::int32_t* const row = rowOf(y);
        plain.insert(plain.end(), row + cells.x0, row + cells.x1);
        if (y + 1 == cells.y1 || plain.size() + across > kStripe) {
            appendFrame(plain, packed, writer);
            plain.clear();
            if (between) {
                between();
            }
        }
    }
    writer.endBlock(place);
}

void encodePacked(const base::Bytes& packed, base::ByteWriter& writer) { writer.putBytes(packed); }

std::shared_ptr<const base::Bytes> packedCells(const CellArray& grid, const CellRect& cells,
                                               const std::function<void()>& between) {
    base::ByteWriter writer;
    encodeCells(grid, cells, writer, between);
    return std::make_shared<const base::Bytes>(writer.bytes());  // a copy, without the writer's spare memory
}

void requireCells(base::ByteReader reader, std::size_t cells) {
    // A block of zstd holds 128 KiB at most, and takes four bytes or more.
    constexpr std::size_t kMostPerByte = (std::size_t{1} << 17) / 4;
    if (cells * sizeof(std::int32_t) > reader.getBlock().size() * kMostPerByte) {
        throw base::FormatError("cells that do not unpack to the grid's size");
    }
}

std::size_t stripesOf(const CellRect& cells) {
    const auto across = static_cast<std::size_t>(cells.x1 - cells.x0);
    const std::size_t rows = static_cast<std::size_t>(cells.y1 - cells.y0),
                      each = std::max<std::size_t>(kStripe / across, 1);
    return (rows + each - 1) / each;
}

void decodeRows(base::ByteReader& reader, const CellRect& cells, std::int32_t most, const RowsToDecode& take,
                const std::function<void(std::size_t)>& decoded) {
    requireCells(reader, countOf(cells));
    Unpacker unpacker(reader.getBlock());
    const int across = cells.x1 - cells.x0;
    const int rows = static_cast<int>(std::max<std::size_t>(kStripe / static_cast<std::size_t>(across), 1));
    std::size_t noted = 0;  // packed bytes that `decoded` knows
    for (int y = cells.y0; y < cells.y1; ++y) {
        std::int32_t* const row = take.rowOf(y);
        unpacker.read(row, static_cast<std::size_t>(across));
        if (std::any_of(row, row + across, [most](std::int32_t n) { return n > most || n < -most; })) {
            throw base::FormatError("a number out of range in a grid");
        }
        if (take.done) {
            take.done(y);
        }
        if (decoded && (y + 1 == cells.y1 || (y + 1 - cells.y0) % rows == 0)) {
            decoded(unpacker.bytes() - std::exchange(noted, unpacker.bytes()));
        }
    }
    unpacker.finish();
}

void decodeCells(base::ByteReader& reader, const CellRect& cells, std::int32_t most, CellArray& grid,
                 const std::function<void(std::size_t)>& decoded) {
    decodeRows(reader, cells, most, {[&](int y) { return grid.row(y) + cells.x0; }}, decoded);
}

}  // namespace sand
