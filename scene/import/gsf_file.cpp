// SPDX-License-Identifier: Apache-2.0
#include "scene/import/gsf_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <istream>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/input_error.hpp"
#include "base/number.hpp"
#include "base/text.hpp"
#include "sand/model/height_field.hpp"
#include "scene/import/no_data.hpp"
#include "scene/import/steady_files.hpp"

namespace scene {
namespace {

constexpr std::string_view kMagic = "Gwyddion Simple Field 1.0\n";
constexpr double kSquare = 1e-6;  // largest difference of a pixel's sides, as a share

struct Entry {
    std::string value;
    long line = 0;
};

/// Text header of a file, with the zeros behind it.
class Header {
public:
    /// Reads the header. The next byte of `stream` is then the first number.
    Header(std::istream& stream, std::string file) : file_(std::move(file)) {
        std::string text(kMagic.size(), '\0');
        stream.read(text.data(), static_cast<std::streamsize>(text.size()));
        if (!stream || text != kMagic) {
            throw base::InputError(file_, 1, "a Gwyddion Simple Field begins with 'Gwyddion Simple Field 1.0'");
        }
        std::getline(stream, text, '\0');
        if (stream.eof() || !stream) {
            throw base::InputError(file_ + ": its header has no end: zeros must come before the numbers");
        }
        const std::size_t end = kMagic.size() + text.size();
        size_ = end / 4 * 4 + 4;
        for (std::size_t at = end + 1; at < size_; ++at) {
            if (stream.get() != '\0') {
                throw base::InputError(file_ + ": zeros up to a multiple of four bytes must come before the numbers");
            }
        }
        long line = 1;
        for (std::size_t at = 0; at < text.size();) {
            const std::size_t stop = std::min(text.find('\n', at), text.size());
            add(std::string_view(text).substr(at, stop - at), ++line);
            at = stop + 1;
        }
    }

    [[nodiscard]] std::size_t size() const { return size_; }  // [byte], zeros included

    [[nodiscard]] int side(const std::string& name) const {
        const Entry* entry = find(name);
        if (entry == nullptr) {
            throw base::InputError(fmt::format("{}: its header has no {}", file_, name));
        }
        const double side = number(name, *entry);
        if (side != std::floor(side) || side < 1 || side > sand::kMaxSide) {
            fail(*entry,
                 fmt::format("{} must be a whole number within [1, {}], got {}", name, sand::kMaxSide, entry->value));
        }
        return static_cast<int>(side);
    }
    /// Returns a length [m].
    [[nodiscard]] double length(const std::string& name) const {
        const Entry* entry = find(name);
        const double length = entry == nullptr ? 1.0 : number(name, *entry);
        if (!(length > 0)) {
            fail(*entry, fmt::format("{} must be positive, got {}", name, entry->value));
        }
        return length;
    }
    void wantMetres(const std::string& name) const {
        if (const Entry* entry = find(name); entry != nullptr && entry->value != "m" && !entry->value.empty()) {
            fail(*entry, fmt::format("{} must be m for a scan of heights, got '{}'", name, entry->value));
        }
    }

private:
    void add(std::string_view text, long line) {
        const std::size_t equals = text.find('=');
        if (equals == std::string_view::npos) {
            throw base::InputError(file_, line, fmt::format("expected 'Name = value', got '{}'", text));
        }
        entries_[std::string(base::trimmed(text.substr(0, equals)))] = {
            std::string(base::trimmed(text.substr(equals + 1))), line};
    }
    [[nodiscard]] const Entry* find(const std::string& name) const {
        const auto found = entries_.find(name);
        return found == entries_.end() ? nullptr : &found->second;
    }
    [[nodiscard]] double number(const std::string& name, const Entry& entry) const {
        const std::optional<double> value = base::numberOf(entry.value);
        if (!value) {
            fail(entry, fmt::format("{} must be a finite number, got '{}'", name, entry.value));
        }
        return *value;
    }
    [[noreturn]] void fail(const Entry& entry, const std::string& message) const {
        throw base::InputError(file_, entry.line, message);
    }

    std::string file_;
    std::map<std::string, Entry> entries_;
    std::size_t size_ = 0;
};

/// Reads the numbers row by row.
RasterHeights heightsFrom(std::istream& stream, const EsriGrid& grid, const RasterCheck& check) {
    const auto width = static_cast<std::size_t>(grid.columns);
    RasterHeights heights(NumberSize::floats);
    heights.reserve(width * static_cast<std::size_t>(grid.rows));
    std::vector<float> row(width);
    for (int fromNorth = 0; fromNorth < grid.rows; ++fromNorth) {
        stream.read(reinterpret_cast<char*>(row.data()), static_cast<std::streamsize>(width * sizeof(float)));
        if (!stream) {
            throw base::InputError(grid.file + ": cannot be read to its end; check the disk it lies on");
        }
        const auto infinite = std::find_if(row.begin(), row.end(), [](float height) { return std::isinf(height); });
        if (infinite != row.end()) {
            throw base::InputError(
                fmt::format("{}: the height of pixel {}, {} (from the north-west) is infinite; mask it in Gwyddion",
                            grid.file, infinite - row.begin() + 1, fromNorth + 1));
        }
        for (const float height : row) {
            heights.add(height);
        }
        check.read((fromNorth + 1.0) / grid.rows);
    }
    return heights;
}

}  // namespace

EsriGrid readGsf(const std::filesystem::path& file, const RasterCheck& check) {
    std::error_code failed;
    std::ifstream stream(file, std::ios::binary);
    const bool plain = std::filesystem::is_regular_file(file, failed);  // devices may never end
    const std::uintmax_t bytes = plain ? std::filesystem::file_size(file, failed) : 0;
    if (!stream || !plain || failed) {
        throw base::InputError(fmt::format("{}: cannot be read; check the path", file.string()));
    }
    const Header header(stream, file.string());
    EsriGrid grid;
    grid.file = file.string();
    grid.columns = header.side("XRes");
    grid.rows = header.side("YRes");
    header.wantMetres("XYUnits");
    header.wantMetres("ZUnits");
    grid.units = {.lengthMetres = 1, .heightMetres = 1, .heightName = "m"};
    grid.origins = {"format", "format"};
    grid.cellSize = header.length("XReal") / grid.columns;
    const double depth = header.length("YReal") / grid.rows;
    if (std::abs(depth - grid.cellSize) > kSquare * grid.cellSize) {
        grid.cellDepth = depth;
    }
    const std::size_t cells = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
    const std::uintmax_t behind = bytes - std::min<std::uintmax_t>(bytes, header.size());
    if (behind != cells * sizeof(float)) {
        throw base::InputError(fmt::format("{}: {} x {} pixels are {} bytes, but {} follow the header", file.string(),
                                           grid.columns, grid.rows, cells * sizeof(float), behind));
    }
    const SteadyFiles steady({file});
    check({grid.columns, grid.rows, NumberSize::floats, false});  // any number may be NaN
    grid.heights = steady.read([&] { return heightsFrom(stream, grid, check); });
    grid.warnings = undeclaredNoData(grid, "if it does, mask these pixels in Gwyddion");
    return grid;
}

}  // namespace scene
