// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "base/byte_stream.hpp"
#include "sand/model/height_field.hpp"

namespace sand {

/// What bears the sand where it is not bottomless: bedrock, on which a layer of sand lies, and cells without data,
/// which are walls. Only scenes with bedrock or walls have one. It never changes. Not thread-safe while being filled.
class Ground {
public:
    /// No bedrock and no wall anywhere.
    Ground(int columns, int rows);

    /// Puts rock at `height` [unit], at most the sand's own: a layer is never thinner than nothing.
    void setBedrock(int column, int row, std::int32_t height) { bed_.row(row)[column] = height; }
    void setWall(int column, int row) { bed_.row(row)[column] = kWall; }

    [[nodiscard]] bool isWall(int column, int row) const { return bed_.row(row)[column] == kWall; }
    /// Height of the rock [unit], or kBottomless; meaningless for a wall.
    [[nodiscard]] std::int32_t bedrock(int column, int row) const { return bed_.row(row)[column]; }
    /// How much sand lies in a cell whose surface is at `height` [unit]: nothing in a wall, at most 2^29 elsewhere.
    [[nodiscard]] std::int32_t sand(int column, int row, std::int32_t height) const {
        return isWall(column, row) ? 0 : height - bedrock(column, row);
    }
    [[nodiscard]] const CellArray& cells() const { return bed_; }
    /// Equal digests mean equal rock and walls; never 0.
    [[nodiscard]] std::uint64_t digest() const;
    /// Reads what encodeCells() wrote of cells(). Throws base::FormatError, also for rock above the sand of `field`.
    static Ground decode(base::ByteReader& reader, const HeightField& field);

    static constexpr std::int32_t kBottomless = -kMaxHeight;
    static constexpr std::int32_t kWall = std::numeric_limits<std::int32_t>::max();

private:
    CellArray bed_;
};

}  // namespace sand
