// SPDX-License-Identifier: Apache-2.0
#include "sand/heights_codec.hpp"

#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <string>

namespace sand {

void encodeHeights(const HeightField& field, files::ByteWriter& writer) {
    std::vector<std::int32_t> plain;
    plain.reserve(static_cast<std::size_t>(field.columns()) * static_cast<std::size_t>(field.rows()));
    for (int y = 0; y < field.rows(); ++y) {
        plain.insert(plain.end(), field.row(y), field.row(y) + field.columns());
    }
    const std::size_t size = plain.size() * sizeof plain[0];
    files::Bytes packed(ZSTD_compressBound(size));
    const std::size_t used = ZSTD_compress(packed.data(), packed.size(), plain.data(), size, 1);
    if (ZSTD_isError(used) != 0) {
        throw files::FormatError(std::string("zstd: ") + ZSTD_getErrorName(used));
    }
    packed.resize(used);
    writer.putBlock(packed);
}

void decodeHeights(files::ByteReader& reader, HeightField& field) {
    const auto packed = reader.getBlock();
    std::vector<std::int32_t> plain(static_cast<std::size_t>(field.columns()) * static_cast<std::size_t>(field.rows()));
    const std::size_t size = plain.size() * sizeof plain[0];
    if (ZSTD_decompress(plain.data(), size, packed.data(), packed.size()) != size) {
        throw files::FormatError("heights that do not unpack to the field's size");
    }
    const auto outside = [](std::int32_t height) { return height > kMaxHeight || height < -kMaxHeight; };
    if (std::any_of(plain.begin(), plain.end(), outside)) {
        throw files::FormatError("a height out of range");
    }
    auto next = plain.begin();
    for (int y = 0; y < field.rows(); ++y) {
        std::copy(next, next + field.columns(), field.row(y));
        next += field.columns();
    }
}

}  // namespace sand
