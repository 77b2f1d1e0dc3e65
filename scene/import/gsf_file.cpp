// SPDX-License-Identifier: Apache-2.0
#include "scene/import/gsf_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <string_view>

#include "base/byte_stream.hpp"
#include "base/input_error.hpp"
#include "base/text.hpp"
#include "sand/model/height_field.hpp"

namespace scene {
namespace {

constexpr std::string_view kMagic = "Gwyddion Simple Field 1.0\n";
constexpr double kSquare = 1e-6;  // by which share the sides of a pixel may differ

struct Entry {
    std::string value;
    long line = 0;
};

/// The text header of a file.
class Header {
public:
    Header(std::string_view bytes, std::string file) : file_(std::move(file)) {
        if (bytes.substr(0, kMagic.size()) != kMagic) {
            throw base::InputError(file_, 1, "a Gwyddion Simple Field begins with 'Gwyddion Simple Field 1.0'");
        }
        const std::size_t end = bytes.find('\0');
        if (end == std::string_view::npos) {
            throw base::InputError(file_ + ": its header has no end: zeros must stand before the numbers");
        }
        size_ = end / 4 * 4 + 4;
        if (size_ > bytes.size() || bytes.substr(end, size_ - end) != std::string(size_ - end, '\0')) {
            throw base::InputError(file_ + ": zeros up to a multiple of four bytes must stand before the numbers");
        }
        long line = 1;
        for (std::size_t at = kMagic.size(); at < end;) {
            const std::size_t stop = std::min(bytes.find('\n', at), end);
            add(bytes.substr(at, stop - at), ++line);
            at = stop + 1;
        }
    }

    [[nodiscard]] std::size_t size() const { return size_; }  // [byte], zeros included

    [[nodiscard]] int side(const std::string& name) const {
        const Entry* entry = find(name);
        if (entry == nullptr) {
            throw base::InputError(fmt::format("{}: its header says no {}", file_, name));
        }
        const double side = number(name, *entry);
        if (side != std::floor(side) || side < 1 || side > sand::kMaxSide) {
            fail(*entry,
                 fmt::format("{} must be a whole number within [1, {}], got {}", name, sand::kMaxSide, entry->value));
        }
        return static_cast<int>(side);
    }
    /// [m]
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
            fail(*entry, fmt::format("{} must be m, as of a scan of heights, got '{}'", name, entry->value));
        }
    }

private:
    void add(std::string_view text, long line) {
        const std::size_t equals = text.find('=');
        if (equals == std::string_view::npos) {
            throw base::InputError(file_, line, fmt::format("'Name = value' is wanted, got '{}'", text));
        }
        entries_[std::string(base::trimmed(text.substr(0, equals)))] = {
            std::string(base::trimmed(text.substr(equals + 1))), line};
    }
    [[nodiscard]] const Entry* find(const std::string& name) const {
        const auto found = entries_.find(name);
        return found == entries_.end() ? nullptr : &found->second;
    }
    [[nodiscard]] double number(const std::string& name, const Entry& entry) const {
        double value = 0;
        const char* last = entry.value.data() + entry.value.size();
        const auto [end, error] = std::from_chars(entry.value.data(), last, value);
        if (error != std::errc() || end != last || !std::isfinite(value)) {
            fail(entry, fmt::format("{} must be a finite number, got '{}'", name, entry.value));
        }
        return value;
    }
    [[noreturn]] void fail(const Entry& entry, const std::string& message) const {
        throw base::InputError(file_, entry.line, message);
    }

    std::string file_;
    std::map<std::string, Entry> entries_;
    std::size_t size_ = 0;
};

std::string bytesOf(const std::filesystem::path& file) {
    std::error_code ignored;
    std::ifstream stream(file, std::ios::binary);
    if (!stream || !std::filesystem::is_regular_file(file, ignored)) {  // devices may never end
        throw base::InputError(fmt::format("{}: cannot be read; check the path", file.string()));
    }
    return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

EsriGrid readGsf(const std::filesystem::path& file) {
    const std::string bytes = bytesOf(file);
    const Header header(bytes, file.string());
    EsriGrid grid;
    grid.file = file.string();
    grid.columns = header.side("XRes");
    grid.rows = header.side("YRes");
    header.wantMetres("XYUnits");
    header.wantMetres("ZUnits");
    grid.units = {.lengthMetres = 1, .heightMetres = 1, .heightName = "m"};
    grid.cellSize = header.length("XReal") / grid.columns;
    const double depth = header.length("YReal") / grid.rows;
    if (std::abs(depth - grid.cellSize) > kSquare * grid.cellSize) {
        grid.cellDepth = depth;
    }
    const std::size_t cells = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
    const std::string_view numbers = std::string_view(bytes).substr(header.size());
    if (numbers.size() != cells * sizeof(float)) {
        throw base::InputError(fmt::format("{}: {} x {} pixels are {} bytes, and behind the header stand {}",
                                           file.string(), grid.columns, grid.rows, cells * sizeof(float),
                                           numbers.size()));
    }
    for (std::size_t i = 0; i < cells; ++i) {
        float height = 0;
        std::memcpy(&height, numbers.data() + i * sizeof height, sizeof height);
        if (std::isinf(height)) {
            const auto width = static_cast<std::size_t>(grid.columns);
            throw base::InputError(
                fmt::format("{}: the height of pixel {}, {} (from the north-west) is infinite; "
                            "mask it in Gwyddion",
                            file.string(), i % width + 1, i / width + 1));
        }
        grid.heights.push_back(height);
    }
    return grid;
}

}  // namespace scene
