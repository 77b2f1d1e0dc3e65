// SPDX-License-Identifier: Apache-2.0
#include "scene/import/esri_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/input_error.hpp"
#include "base/number.hpp"
#include "base/text.hpp"
#include "base/text_reader.hpp"
#include "host/whole_file.hpp"
#include "sand/model/height_field.hpp"
#include "scene/import/no_data.hpp"
#include "scene/import/prj_file.hpp"

namespace scene {
namespace {

/// Words of the text of a grid.
class Words : public base::TextReader {
public:
    using base::TextReader::TextReader;

    /// Returns the next word as a finite number. Ignores the locale.
    double number(std::string_view what) {
        const std::string word(nextWord());
        if (word.empty()) {
            fail(fmt::format("the file ends where {} should be", what));
        }
        const std::optional<double> value = base::numberOf(word);
        if (!value) {
            fail(fmt::format("{} must be a finite number, got '{}'{}", what, word,
                             base::commaNumberOf(word) ? "; write a decimal point" : ""));
        }
        return *value;
    }
};

int sideOf(Words& words, const std::string& key) {
    const double side = words.number(key);
    if (side != std::floor(side) || side < 1 || side > sand::kMaxSide) {
        words.fail(fmt::format("{} must be a whole number within [1, {}], got {}", key, sand::kMaxSide, side));
    }
    return static_cast<int>(side);
}

constexpr double kNoData = std::numeric_limits<double>::quiet_NaN();

double sizeOf(Words& words, const std::string& key) {
    const double size = words.number(key);
    if (!(size > 0)) {
        words.fail(fmt::format("{} must be positive, got {}", key, size));
    }
    return size;
}

/// Keys with which a header may begin.
constexpr std::array<std::string_view, 10> kKeys{"ncols",     "nrows",     "cellsize",  "dx",        "dy",
                                                 "xllcorner", "xllcenter", "yllcorner", "yllcenter", "nodata_value"};

std::ifstream opened(const std::filesystem::path& file) {
    std::error_code ignored;
    std::ifstream stream(file, std::ios::binary);
    if (!stream || std::filesystem::is_directory(file, ignored) ||
        std::filesystem::is_character_file(file, ignored)) {  // devices may never end
        throw base::InputError(fmt::format("{}: cannot be read; check the path", file.string()));
    }
    return stream;
}

/// Returns the largest number of heights that a file can hold: each takes a digit and a blank. A false header must not
/// make the program allocate gigabytes.
std::size_t mostHeightsIn(const std::filesystem::path& file) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    return error ? std::size_t{1} << 20 : static_cast<std::size_t>(bytes / 2 + 1);
}

/// Reads the number that means no data: any number, or the "nan" that GDAL writes.
double noDataOf(Words& words, const std::string& key) {
    if (base::spellsNan(words.peekWord())) {
        (void)words.nextWord();
        return kNoData;
    }
    return words.number(key);
}

void readHeader(Words& words, EsriGrid& grid) {
    bool centreX = false, centreY = false;  // files of some programs give the corner of one and the centre of the other
    double square = 0;
    const auto isKey = [](std::string_view word) {
        return !word.empty() && std::isalpha(static_cast<unsigned char>(word.front())) != 0 && !base::spellsNan(word);
    };
    while (isKey(words.peekWord())) {
        const std::string key = base::lowerCase(words.nextWord());
        if (key == "ncols") {
            grid.columns = sideOf(words, key);
        } else if (key == "nrows") {
            grid.rows = sideOf(words, key);
        } else if (key == "cellsize") {
            square = sizeOf(words, key);
        } else if (key == "dx") {
            grid.cellSize = sizeOf(words, key);
        } else if (key == "dy") {
            grid.cellDepth = sizeOf(words, key);
        } else if (key == "xllcorner" || key == "xllcenter") {
            grid.westEdge = words.number(key);
            centreX = key == "xllcenter";
        } else if (key == "yllcorner" || key == "yllcenter") {
            grid.southEdge = words.number(key);
            centreY = key == "yllcenter";
        } else if (key == "nodata_value") {
            grid.noData = noDataOf(words, key);
        } else {
            words.fail(fmt::format("'{}' is not a key of an ESRI ASCII grid", key));
        }
    }
    const bool dx = grid.cellSize > 0;
    const bool dy = grid.cellDepth.has_value();
    if (grid.columns == 0 || grid.rows == 0 || dx != dy || dx == (square > 0)) {
        words.fail("an ESRI ASCII grid begins with ncols, nrows, and either cellsize or dx and dy");
    }
    if (square > 0) {
        grid.cellSize = square;
    }
    grid.westEdge -= centreX ? grid.cellSize / 2 : 0;
    grid.southEdge -= centreY ? grid.cellDepth.value_or(grid.cellSize) / 2 : 0;
}

/// Reads the next word as a height, or as no data.
double heightOf(Words& words, const EsriGrid& grid) {
    if (grid.noData && std::isnan(*grid.noData) && base::spellsNan(words.peekWord())) {
        (void)words.nextWord();
        return kNoData;
    }
    const double height = words.number("a height");
    return grid.noData && meansNoData(height, *grid.noData) ? kNoData : height;
}

/// Returns the number with which a written grid marks cells without data: the grid's own, or else a usual one that no
/// height means when it is read again.
double freeNoData(const EsriGrid& grid) {
    const auto isFree = [&](double number) {
        return std::none_of(grid.heights.begin(), grid.heights.end(),
                            [&](double height) { return !std::isnan(height) && meansNoData(height, number); });
    };
    for (const double number : {grid.noData.value_or(-9999), -9999.0, -99999.0, -32768.0, -1e30}) {
        if (isFree(number)) {
            return number;
        }
    }
    return kNoData;
}

}  // namespace

EsriGrid readEsriGrid(const std::filesystem::path& file, const RasterCheck& check) {
    if (const std::optional<PrjFile> prj = prjBeside(file); prj && prj->inDegrees()) {
        throw base::InputError(fmt::format(
            "{}: its coordinates ({}) are degrees, but sand needs lengths; make metres of them with gdalwarp -t_srs",
            file.string(), prj->file.filename().string()));
    }
    std::ifstream stream = opened(file);
    Words words(stream, file.string());
    EsriGrid grid;
    grid.file = file.string();
    readHeader(words, grid);
    if (check) {
        check(grid.columns, grid.rows, !grid.noData);
    }
    const std::size_t cells = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
    grid.heights.reserve(std::min(cells, mostHeightsIn(file)));
    for (std::size_t i = 0; i < cells; ++i) {
        grid.heights.push_back(heightOf(words, grid));
        if (i % static_cast<std::size_t>(grid.columns) == 0) {
            grid.lines.push_back(words.line());
        }
    }
    if (!words.nextWord().empty()) {
        words.fail(fmt::format("more values than ncols x nrows = {}", cells));
    }
    if (stream.bad()) {
        throw base::InputError(file.string() + ": cannot be read to its end; check the disk it lies on");
    }
    grid.warnings = undeclaredNoData(grid, "if it does, add the line 'NODATA_value {0}' to the header");
    return grid;
}

bool holdsEsriGrid(const std::filesystem::path& file) {
    std::error_code none;
    if (!std::filesystem::is_regular_file(file, none)) {
        return false;
    }
    std::array<char, 256> first{};
    std::ifstream stream(file, std::ios::binary);
    stream.read(first.data(), first.size());
    // Whole characters of UTF-16, the longest of which has four bytes. The end of a longer file is not there.
    const std::size_t size = static_cast<std::size_t>(stream.gcount()) / 4 * 4;
    std::string word;
    try {
        base::TextReader text(std::string_view(first.data(), size), file.string());
        word = base::lowerCase(text.nextWord());
    } catch (const base::InputError&) {
        return false;  // bytes of another format
    }
    return std::find(kKeys.begin(), kKeys.end(), word) != kKeys.end();
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

EsriGrid withoutEmptyEdges(const EsriGrid& grid) {
    const sand::CellRect filled = cellsWithData(grid);
    if (filled.empty()) {
        throw base::InputError(grid.file + ": every cell is a no-data cell; there is no terrain in it");
    }
    EsriGrid result = grid;
    result.columns = filled.x1 - filled.x0;
    result.rows = filled.y1 - filled.y0;
    result.westEdge += filled.x0 * grid.cellSize;
    result.southEdge += filled.y0 * grid.cellDepth.value_or(grid.cellSize);
    result.heights.clear();
    for (int row = filled.y1 - 1; row >= filled.y0; --row) {
        const double* cells = grid.heights.data() + grid.index(0, row);
        result.heights.insert(result.heights.end(), cells + filled.x0, cells + filled.x1);
    }
    if (!grid.lines.empty()) {
        const auto first = grid.lines.begin() + (grid.rows - filled.y1);
        result.lines.assign(first, first + result.rows);
    }
    return result;
}

void writeEsriGrid(const EsriGrid& grid, const std::filesystem::path& file) {
    host::WholeFile whole(file);
    const std::string cells = grid.cellDepth ? fmt::format("dx {}\ndy {}", grid.cellSize, *grid.cellDepth)
                                             : fmt::format("cellsize {}", grid.cellSize);
    whole.stream() << fmt::format("ncols {}\nnrows {}\nxllcorner {}\nyllcorner {}\n{}\n", grid.columns, grid.rows,
                                  grid.westEdge, grid.southEdge, cells);
    const auto& heights = grid.heights;
    const double noData = freeNoData(grid);
    if (grid.noData || std::any_of(heights.begin(), heights.end(), [](double height) { return std::isnan(height); })) {
        whole.stream() << fmt::format("NODATA_value {}\n", noData);
    }
    std::string line;
    for (int row = grid.rows - 1; row >= 0; --row) {
        line.clear();
        for (int column = 0; column < grid.columns; ++column) {
            fmt::format_to(std::back_inserter(line), "{} ", grid.isNoData(column, row) ? noData : grid.at(column, row));
        }
        line.back() = '\n';
        whole.stream() << line;
    }
    whole.keep();
}

double withFewDecimals(double height, double unit) {
    const double power = std::pow(10, std::max(std::ceil(-std::log10(unit)) + 2, 0.0));
    const double shifted = std::round(height * power);
    return std::isfinite(shifted) ? shifted / power : height;
}

}  // namespace scene
