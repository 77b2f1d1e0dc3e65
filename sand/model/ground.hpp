// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "base/byte_stream.hpp"
#include "sand/model/height_field.hpp"

namespace sand {

/// Ground of a height field: bedrock under a layer of sand, and wall cells, which have no data.
///
/// Only scenes with bedrock or wall cells have a Ground. It never changes once it is filled. Not thread-safe while it
/// is filled.
class Ground {
public:
    /// Creates ground without bedrock and without wall cells.
    Ground(int columns, int rows);

    /// Puts rock at `height` [unit]. The rock must not be higher than the sand's surface, because a layer of sand
    /// cannot have a negative thickness.
    void setBedrock(int column, int row, std::int32_t height) { bed_.row(row)[column] = height; }
    void setWall(int column, int row) { bed_.row(row)[column] = kWall; }

    [[nodiscard]] bool isWall(int column, int row) const { return bed_.row(row)[column] == kWall; }
    /// Returns the height of the rock [unit], or kBottomless where the sand has unlimited depth. The result for a wall
    /// cell has no meaning.
    [[nodiscard]] std::int32_t bedrock(int column, int row) const { return bed_.row(row)[column]; }
    /// Returns the thickness of the sand in a cell whose surface is at `height` [unit]. It is 0 in a wall cell and at
    /// most 2^29 elsewhere.
    [[nodiscard]] std::int32_t sand(int column, int row, std::int32_t height) const {
        return isWall(column, row) ? 0 : height - bedrock(column, row);
    }
    [[nodiscard]] const CellArray& cells() const { return bed_; }
    /// Returns a hash of rock and wall cells, which is never 0. Equal digests mean equal ground.
    [[nodiscard]] std::uint64_t digest() const;
    /// Reads what encodeCells() wrote of cells(). Throws base::FormatError for invalid bytes, and for rock above the
    /// sand of `field`.
    static Ground decode(base::ByteReader& reader, const HeightField& field);

    static constexpr std::int32_t kBottomless = -kMaxHeight;
    static constexpr std::int32_t kWall = std::numeric_limits<std::int32_t>::max();

private:
    CellArray bed_;
};

}  // namespace sand
