// SPDX-License-Identifier: Apache-2.0
#include "scene/import/esri_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "base/input_error.hpp"
#include "base/number.hpp"
#include "base/text.hpp"
#include "sand/model/height_field.hpp"
#include "scene/import/no_data.hpp"

namespace scene {
namespace {

/// Returns the next word as a finite number. Ignores the locale.
double numberFrom(base::TextReader& text, std::string_view what) {
    const std::string word(text.nextWord());
    if (word.empty()) {
        text.fail(fmt::format("the file ends where {} should be", what));
    }
    const std::optional<double> value = base::numberOf(word);
    if (!value) {
        text.fail(fmt::format("{} must be a finite number, got '{}'{}", what, word,
                              base::commaNumberOf(word) ? "; write a decimal point" : ""));
    }
    return *value;
}

int sideOf(base::TextReader& text, const std::string& key) {
    const double side = numberFrom(text, key);
    if (side != std::floor(side) || side < 1 || side > sand::kMaxSide) {
        text.fail(fmt::format("{} must be a whole number within [1, {}], got {}", key, sand::kMaxSide, side));
    }
    return static_cast<int>(side);
}

constexpr double kNoData = std::numeric_limits<double>::quiet_NaN();

double sizeOf(base::TextReader& text, const std::string& key) {
    const double size = numberFrom(text, key);
    if (!(size > 0)) {
        text.fail(fmt::format("{} must be positive, got {}", key, size));
    }
    return size;
}

/// Reads the number that means no data: any number, or the "nan" that GDAL writes.
double noDataOf(base::TextReader& text, const std::string& key) {
    if (base::spellsNan(text.peekWord())) {
        (void)text.nextWord();
        return kNoData;
    }
    return numberFrom(text, key);
}

void readHeader(base::TextReader& text, EsriGrid& grid) {
    bool centreX = false, centreY = false;  // files of some programs give the corner of one and the centre of the other
    double square = 0;
    const auto isKey = [](std::string_view word) {
        return !word.empty() && std::isalpha(static_cast<unsigned char>(word.front())) != 0 && !base::spellsNan(word);
    };
    while (isKey(text.peekWord())) {
        const std::string key = base::lowerCase(text.nextWord());
        if (key == "ncols") {
            grid.columns = sideOf(text, key);
        } else if (key == "nrows") {
            grid.rows = sideOf(text, key);
        } else if (key == "cellsize") {
            square = sizeOf(text, key);
        } else if (key == "dx") {
            grid.cellSize = sizeOf(text, key);
        } else if (key == "dy") {
            grid.cellDepth = sizeOf(text, key);
        } else if (key == "xllcorner" || key == "xllcenter") {
            grid.westEdge = numberFrom(text, key);
            centreX = key == "xllcenter";
        } else if (key == "yllcorner" || key == "yllcenter") {
            grid.southEdge = numberFrom(text, key);
            centreY = key == "yllcenter";
        } else if (key == "nodata_value") {
            grid.noData = noDataOf(text, key);
        } else {
            text.fail(fmt::format("'{}' is not a key of an ESRI ASCII grid", key));
        }
    }
    const bool dx = grid.cellSize > 0;
    const bool dy = grid.cellDepth.has_value();
    if (grid.columns == 0 || grid.rows == 0 || dx != dy || dx == (square > 0)) {
        text.fail("an ESRI ASCII grid begins with ncols, nrows, and either cellsize or dx and dy");
    }
    if (square > 0) {
        grid.cellSize = square;
    }
    grid.westEdge -= centreX ? grid.cellSize / 2 : 0;
    grid.southEdge -= centreY ? grid.cellDepth.value_or(grid.cellSize) / 2 : 0;
}

/// Reads the next word as a height, or as no data.
double heightOf(base::TextReader& text, const EsriGrid& grid) {
    if (grid.noData && std::isnan(*grid.noData) && base::spellsNan(text.peekWord())) {
        (void)text.nextWord();
        return kNoData;
    }
    const double height = numberFrom(text, "a height");
    return grid.noData && meansNoData(height, *grid.noData) ? kNoData : height;
}

}  // namespace

void checkEsriHeader(base::TextReader& text, const RasterCheck& check) {
    EsriGrid grid;
    readHeader(text, grid);
    check({grid.columns, grid.rows, NumberSize::doubles, !grid.noData});
}

EsriGrid readEsriText(base::TextReader& text, const RasterCheck& check, std::size_t mostHeights) {
    EsriGrid grid;
    grid.file = text.file();
    readHeader(text, grid);
    check({grid.columns, grid.rows, NumberSize::doubles, !grid.noData});
    const std::size_t cells = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
    grid.heights.reserve(std::min(cells, mostHeights));
    for (std::size_t i = 0; i < cells; ++i) {
        grid.heights.add(heightOf(text, grid));
        if (i % static_cast<std::size_t>(grid.columns) == 0) {
            grid.lines.push_back(text.line());
            check.read(static_cast<double>(i) / static_cast<double>(cells));
        }
    }
    if (!text.nextWord().empty()) {
        text.fail(fmt::format("more values than ncols x nrows = {}", cells));
    }
    grid.warnings = undeclaredNoData(grid, "if it does, add the line 'NODATA_value {0}' to the header");
    return grid;
}

void EsriGrid::fail(int column, int rowFromSouth, const std::string& message) const {
    if (lines.empty()) {
        throw base::InputError(
            fmt::format("{}: pixel {}, {} (from the north-west): {}", file, column + 1, rows - rowFromSouth, message));
    }
    const long line = lines[static_cast<std::size_t>(rows - 1 - rowFromSouth)];
    throw base::InputError(file, line, fmt::format("column {} of this row: {}", column + 1, message));
}

sand::CellRect cellsWithData(const EsriGrid& grid) {
    sand::CellRect filled{grid.columns, grid.rows, 0, 0};
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            if (!grid.isNoData(column, row)) {
                filled = {std::min(filled.x0, column), std::min(filled.y0, row), std::max(filled.x1, column + 1),
                          row + 1};
            }
        }
    }
    return filled.empty() ? sand::CellRect{} : filled;
}

EsriGrid withoutEmptyEdges(EsriGrid grid) {
    const sand::CellRect filled = cellsWithData(grid);
    if (filled.empty()) {
        throw base::InputError(grid.file + ": every cell is a no-data cell; there is no terrain in it");
    }
    const int north = grid.rows - filled.y1;  // rows that are cut off
    grid.heights.keepPart(grid.columns, {filled.x0, north, filled.x1, grid.rows - filled.y0});
    grid.columns = filled.x1 - filled.x0;
    grid.rows = filled.y1 - filled.y0;
    grid.westEdge += filled.x0 * grid.cellSize;
    grid.southEdge += filled.y0 * grid.cellDepth.value_or(grid.cellSize);
    if (!grid.lines.empty()) {
        grid.lines.erase(grid.lines.begin(), grid.lines.begin() + north);
        grid.lines.resize(static_cast<std::size_t>(grid.rows));
    }
    return grid;
}

double withFewDecimals(double height, double unit) {
    const double power = std::pow(10, std::max(std::ceil(-std::log10(unit)) + 2, 0.0));
    const double shifted = std::round(height * power);
    return std::isfinite(shifted) ? shifted / power : height;
}

}  // namespace scene
