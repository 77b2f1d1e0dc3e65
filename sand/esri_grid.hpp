// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace sand {

/// A raster as ESRI ASCII grids hold it: square cells, rows from the north.
struct EsriGrid {
    int columns = 0, rows = 0;
    double cellSize = 0;                 // [file's length unit]
    double westEdge = 0, southEdge = 0;  // of the south-west cell [file's length unit]
    std::vector<double> heights;         // [file's height unit], row by row, north first

    [[nodiscard]] double at(int column, int rowFromSouth) const {
        return heights[static_cast<std::size_t>(rows - 1 - rowFromSouth) * static_cast<std::size_t>(columns) +
                       static_cast<std::size_t>(column)];
    }
};

/// Throws files::InputError with file and line: a header that is not one, values missing, too many or not finite, or a
/// no-data cell amid the others. Rows and columns at the edges that hold no data at all are cut off.
[[nodiscard]] EsriGrid readEsriGrid(const std::filesystem::path& file);

/// Writes with nine digits. Throws files::InputError when the file cannot be written whole.
void writeEsriGrid(const EsriGrid& grid, const std::filesystem::path& file);

}  // namespace sand
