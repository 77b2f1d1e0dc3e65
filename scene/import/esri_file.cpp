// SPDX-License-Identifier: Apache-2.0
#include "scene/import/esri_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>

#include "base/input_error.hpp"
#include "base/text.hpp"
#include "base/text_reader.hpp"
#include "host/whole_file.hpp"
#include "scene/import/esri_grid.hpp"
#include "scene/import/no_data.hpp"
#include "scene/import/prj_file.hpp"
#include "scene/import/steady_files.hpp"

namespace scene {
namespace {

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
    return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

EsriGrid readEsriGrid(const std::filesystem::path& file, const RasterCheck& check) {
    if (const std::optional<PrjFile> prj = prjBeside(file); prj && prj->inDegrees()) {
        throw base::InputError(fmt::format(
            "{}: its coordinates ({}) are degrees, but sand needs lengths; make metres of them with gdalwarp -t_srs",
            file.string(), prj->file.filename().string()));
    }
    std::ifstream stream = opened(file);
    base::TextReader text(stream, file.string());
    return SteadyFiles({file}).read([&] {
        EsriGrid grid = readEsriText(text, check, mostHeightsIn(file));
        if (stream.bad()) {
            throw base::InputError(file.string() + ": cannot be read to its end; check the disk it lies on");
        }
        return grid;
    });
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

}  // namespace scene
