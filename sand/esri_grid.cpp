// SPDX-License-Identifier: Apache-2.0
#include "sand/esri_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "files/input_error.hpp"
#include "sand/height_field.hpp"

namespace sand {
namespace {

/// The words of a text, each with its line.
class Words {
public:
    Words(std::string text, std::string file) : text_(std::move(text)), file_(std::move(file)) {}

    /// Empty at the end of the text.
    std::string_view next() {
        for (; at_ < text_.size() && isSpace(text_[at_]); ++at_) {
            line_ += text_[at_] == '\n' ? 1 : 0;
        }
        const std::size_t start = at_;
        for (; at_ < text_.size() && !isSpace(text_[at_]); ++at_) {
        }
        return std::string_view(text_).substr(start, at_ - start);
    }
    std::string_view peek() {
        const auto [at, line] = std::pair(at_, line_);
        const std::string_view word = next();
        at_ = at;
        line_ = line;
        return word;
    }
    /// The next word as a finite number, whatever the locale.
    double number(std::string_view what) {
        const std::string_view word = next();
        double value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (word.empty()) {
            fail(fmt::format("the file ends where {} should be", what));
        }
        if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
            fail(fmt::format("{} must be a finite number, got '{}'", what, word));
        }
        return value;
    }
    [[nodiscard]] long line() const { return line_; }
    [[noreturn]] void fail(const std::string& message) const { throw files::InputError(file_, line_, message); }

private:
    static bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

    std::string text_;
    std::string file_;
    std::size_t at_ = 0;
    long line_ = 1;
};

std::string lower(std::string_view word) {
    std::string result(word);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return result;
}

int sideOf(Words& words, const std::string& key) {
    const double side = words.number(key);
    if (side != std::floor(side) || side < 1 || side > kMaxSide) {
        words.fail(fmt::format("{} must be a whole number within [1, {}], got {}", key, kMaxSide, side));
    }
    return static_cast<int>(side);
}

/// Reads the header into `grid`; returns the value that stands for no data.
std::optional<double> readHeader(Words& words, EsriGrid& grid) {
    std::optional<double> noData;
    bool centres = false;
    while (!words.peek().empty() && std::isalpha(static_cast<unsigned char>(words.peek().front())) != 0) {
        const std::string key = lower(words.next());
        if (key == "ncols") {
            grid.columns = sideOf(words, key);
        } else if (key == "nrows") {
            grid.rows = sideOf(words, key);
        } else if (key == "cellsize") {
            grid.cellSize = words.number(key);
        } else if (key == "xllcorner" || key == "xllcenter") {
            grid.westEdge = words.number(key);
            centres = key == "xllcenter";
        } else if (key == "yllcorner" || key == "yllcenter") {
            grid.southEdge = words.number(key);
        } else if (key == "nodata_value") {
            noData = words.number(key);
        } else {
            words.fail(fmt::format("'{}' is no key of an ESRI ASCII grid", key));
        }
    }
    if (grid.columns == 0 || grid.rows == 0 || !(grid.cellSize > 0)) {
        words.fail("an ESRI ASCII grid begins with ncols, nrows and a positive cellsize");
    }
    if (centres) {
        grid.westEdge -= grid.cellSize / 2;
        grid.southEdge -= grid.cellSize / 2;
    }
    return noData;
}

constexpr double kNoData = std::numeric_limits<double>::quiet_NaN();  // no file can hold it: it is not finite

/// Cuts off edges without any data, which exporters leave around a rotated or resampled raster. `lines` is where each
/// row begins in the file.
EsriGrid withoutEmptyEdges(const EsriGrid& grid, const std::vector<long>& lines, const std::string& file) {
    int west = grid.columns;
    int east = -1;
    int south = grid.rows;
    int north = -1;
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            if (!std::isnan(grid.at(column, row))) {
                west = std::min(west, column);
                east = std::max(east, column);
                south = std::min(south, row);
                north = row;
            }
        }
    }
    if (east < 0) {
        throw files::InputError(file + ": every cell is a no-data cell; there is no terrain in it");
    }
    EsriGrid result{east - west + 1,
                    north - south + 1,
                    grid.cellSize,
                    grid.westEdge + west * grid.cellSize,
                    grid.southEdge + south * grid.cellSize,
                    {}};
    for (int row = north; row >= south; --row) {
        for (int column = west; column <= east; ++column) {
            if (std::isnan(grid.at(column, row))) {
                throw files::InputError(file, lines[static_cast<std::size_t>(grid.rows - 1 - row)],
                                        fmt::format("no-data cell in column {} of this row, amid others; fill it or "
                                                    "crop the grid",
                                                    column + 1));
            }
            result.heights.push_back(grid.at(column, row));
        }
    }
    return result;
}

}  // namespace

EsriGrid readEsriGrid(const std::filesystem::path& file) {
    std::error_code ignored;
    std::ifstream stream(file, std::ios::binary);
    if (!stream || std::filesystem::is_directory(file, ignored)) {
        throw files::InputError(fmt::format("{}: cannot be read; check the path", file.string()));
    }
    Words words({std::istreambuf_iterator<char>(stream), {}}, file.string());
    EsriGrid grid;
    const std::optional<double> noData = readHeader(words, grid);
    const std::size_t cells = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
    grid.heights.reserve(std::min<std::size_t>(cells, 1 << 20));  // a lying header must not allocate gigabytes
    std::vector<long> lines;                                      // of the first value of each row
    for (std::size_t i = 0; i < cells; ++i) {
        const double height = words.number("a height");
        grid.heights.push_back(noData && height == *noData ? kNoData : height);
        if (i % static_cast<std::size_t>(grid.columns) == 0) {
            lines.push_back(words.line());
        }
    }
    if (!words.next().empty()) {
        words.fail(fmt::format("more values than ncols x nrows = {}", cells));
    }
    return withoutEmptyEdges(grid, lines, file.string());
}

void writeEsriGrid(const EsriGrid& grid, const std::filesystem::path& file) {
    std::ofstream stream(file, std::ios::binary);
    stream << fmt::format("ncols {}\nnrows {}\nxllcorner {}\nyllcorner {}\ncellsize {}\nNODATA_value -9999\n",
                          grid.columns, grid.rows, grid.westEdge, grid.southEdge, grid.cellSize);
    std::size_t next = 0;
    for (int y = 0; y < grid.rows; ++y) {
        for (int x = 0; x < grid.columns; ++x) {
            stream << fmt::format("{:.9g}{}", grid.heights[next++], x + 1 == grid.columns ? '\n' : ' ');
        }
    }
    stream.flush();
    if (!stream) {
        throw files::InputError(fmt::format("{}: cannot be written; check path and free space", file.string()));
    }
}

}  // namespace sand
