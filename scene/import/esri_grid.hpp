// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sand/model/cell_array.hpp"
#include "scene/georeference.hpp"

namespace scene {

/// A raster as ESRI ASCII grids hold it: rows from the north, cells that may have no data. Those that come from other
/// formats say more of their units (scene/import/importer.hpp).
struct EsriGrid {
    int columns = 0, rows = 0;
    double cellSize = 0;                  // of a cell from west to east [file's length unit]
    double westEdge = 0, southEdge = 0;   // of the south-west cell [file's length unit]
    std::vector<double> heights;          // [file's height unit], row by row, north first; not a number: no data
    std::optional<double> cellDepth{};    // of a cell from south to north, where it is not cellSize
    std::optional<double> noData{};       // what stands for no data in the file
    std::string file{};                   // where it was read from, for messages
    std::vector<long> lines{};            // of the file, in which each row begins, north first; empty: no text
    RasterUnits units{};                  // an ESRI ASCII grid says nothing of them
    std::vector<std::string> warnings{};  // one line each, which name the file, for the program to print

    [[nodiscard]] double at(int column, int rowFromSouth) const { return heights[index(column, rowFromSouth)]; }
    [[nodiscard]] bool isNoData(int column, int rowFromSouth) const { return std::isnan(at(column, rowFromSouth)); }
    /// From south to north over from west to east: 1 where cells are square.
    [[nodiscard]] double aspect() const { return cellDepth.value_or(cellSize) / cellSize; }
    [[nodiscard]] std::size_t index(int column, int rowFromSouth) const {
        return static_cast<std::size_t>(rows - 1 - rowFromSouth) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(column);
    }
    /// Heights as the file has them become those that programs hold.
    void countHeightsInLengths() {
        for (double& height : heights) {
            height /= units.heightsPerLength;
        }
    }
    /// Throws base::InputError about this cell, with file and line, or its row where there are no lines.
    [[noreturn]] void fail(int column, int rowFromSouth, const std::string& message) const;
};

/// Called with the size of a raster before its pixels are read; throws to refuse it. `complete` says that the header
/// marks no number as no data, so that every pixel has a height.
using RasterCheck = std::function<void(int columns, int rows, bool complete)>;

/// Reads an ESRI ASCII grid piece by piece. `check` may be empty. Cells that are not square come as GDAL writes them,
/// with dx and dy in place of cellsize. Throws base::InputError with file and line: a header that is not one, values
/// missing, too many or not finite.
[[nodiscard]] EsriGrid readEsriGrid(const std::filesystem::path& file, const RasterCheck& check = {});
/// Returns whether a plain file is one by its first word, which is a key of the header.
[[nodiscard]] bool holdsEsriGrid(const std::filesystem::path& file);

/// The smallest rectangle, from the south-west cell, that holds every cell with data; empty when there is none.
[[nodiscard]] sand::CellRect cellsWithData(const EsriGrid& grid);

/// Less the rows and columns at the edges that hold no data at all, which exporters leave around a rotated or resampled
/// raster. Throws base::InputError when there is no data anywhere.
[[nodiscard]] EsriGrid withoutEmptyEdges(const EsriGrid& grid);

/// Writes the shortest decimals that are read back as the same numbers. What stood at `file` is replaced when all is
/// written. Throws base::InputError when the file cannot be written whole.
void writeEsriGrid(const EsriGrid& grid, const std::filesystem::path& file);

/// A height with as few decimals as tell it from those a `unit` away: within a hundredth of a unit.
[[nodiscard]] double withFewDecimals(double height, double unit);

}  // namespace scene
