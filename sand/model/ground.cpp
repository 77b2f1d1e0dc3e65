// SPDX-License-Identifier: Apache-2.0
#include "sand/model/ground.hpp"

#include <xxhash.h>

#include <algorithm>

#include "sand/model/grid_codec.hpp"

namespace sand {

Ground::Ground(int columns, int rows) : bed_(columns, rows) {
    for (int y = 0; y < rows; ++y) {
        std::fill_n(bed_.row(y), columns, kBottomless);
    }
}

std::uint64_t Ground::digest() const {
    std::uint64_t hash = 1;
    for (int y = 0; y < bed_.rows(); ++y) {
        const auto bytes = static_cast<std::size_t>(bed_.columns()) * sizeof(std::int32_t);
        hash = XXH3_64bits_withSeed(bed_.row(y), bytes, hash);
    }
    return std::max<std::uint64_t>(hash, 1);
}

Ground Ground::decode(base::ByteReader& reader, const HeightField& field) {
    Ground ground(field.columns(), field.rows());
    decodeCells(reader, field.bounds(), kWall, ground.bed_);
    for (int y = 0; y < field.rows(); ++y) {
        for (int x = 0; x < field.columns(); ++x) {
            const std::int32_t sand = ground.sand(x, y, field.height(x, y));
            if (sand < 0 || ground.bedrock(x, y) < kBottomless) {
                throw base::FormatError("rock above the sand that lies on it");
            }
        }
    }
    return ground;
}

}  // namespace sand
