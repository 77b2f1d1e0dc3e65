// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/text_reader.hpp"
#include "sand/model/cell_array.hpp"
#include "scene/import/raster_check.hpp"
#include "scene/import/raster_heights.hpp"
#include "scene/model/georeference.hpp"

namespace scene {

/// Sources of the units of a raster: "EPSG:32633", "vertical datum", "axes", "valley.prj". Empty without a source.
struct UnitOrigins {
    std::string across, up;
};

/// Raster in the form of an ESRI ASCII grid: rows from the north, cells that may have no data. Rasters from other
/// formats have more details about their units (scene/import/importer.hpp).
struct EsriGrid {
    int columns = 0, rows = 0;
    double cellSize = 0;                  // side of a cell from west to east [file's length unit]
    double westEdge = 0, southEdge = 0;   // edges of the south-west cell [file's length unit]
    RasterHeights heights;                // [file's height unit], row by row, north first; NaN without data
    std::optional<double> cellDepth{};    // side of a cell from south to north; nullopt if it is cellSize
    std::optional<double> noData{};       // number that means no data in the file
    std::string file{};                   // the file that it was read from, for messages
    std::vector<long> lines{};            // line in which each row begins, north first; empty unless the file is text
    RasterUnits units{};                  // unknown for an ESRI ASCII grid
    UnitOrigins origins{};                // of `units`
    std::vector<std::string> warnings{};  // one line each, with the file's name, for the program to print

    [[nodiscard]] double at(int column, int rowFromSouth) const { return heights[index(column, rowFromSouth)]; }
    [[nodiscard]] bool isNoData(int column, int rowFromSouth) const { return std::isnan(at(column, rowFromSouth)); }
    /// Returns a cell's side from south to north, divided by its side from west to east: 1 for square cells.
    [[nodiscard]] double aspect() const { return cellDepth.value_or(cellSize) / cellSize; }
    [[nodiscard]] std::size_t index(int column, int rowFromSouth) const {
        return static_cast<std::size_t>(rows - 1 - rowFromSouth) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(column);
    }
    /// Converts heights from the file's unit to the unit of lengths.
    void countHeightsInLengths() { heights.divide(units.heightsPerLength); }
    /// Throws base::InputError about this cell, with file and line, or with its row if there are no lines.
    [[noreturn]] void fail(int column, int rowFromSouth, const std::string& message) const;
};

/// Reads an ESRI ASCII grid. `check` may be empty. Cells that are not square have dx and dy in place of cellsize, as
/// GDAL writes them. `mostHeights` bounds the memory that the header alone makes it allocate [height]. Throws
/// base::InputError with file and line for an invalid header, and for values that are missing, too many or not finite.
[[nodiscard]] EsriGrid readEsriText(base::TextReader& text, const RasterCheck& check, std::size_t mostHeights);
/// Reads only the header of an ESRI ASCII grid, and calls `check`.
void checkEsriHeader(base::TextReader& text, const RasterCheck& check);

/// Returns the smallest rectangle that contains every cell with data, counted from the south-west cell. Returns an
/// empty one if no cell has data.
[[nodiscard]] sand::CellRect cellsWithData(const EsriGrid& grid);

/// Returns the grid without the rows and columns at its edges that hold no data at all. Exporters leave such edges
/// around a rotated or resampled raster. A grid that is moved in is not copied. Throws base::InputError if no cell has
/// data.
[[nodiscard]] EsriGrid withoutEmptyEdges(EsriGrid grid);

/// Returns a height with as few decimals as distinguish it from heights a `unit` away. The error is at most a hundredth
/// of a unit.
[[nodiscard]] double withFewDecimals(double height, double unit);

}  // namespace scene
