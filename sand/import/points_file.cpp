// SPDX-License-Identifier: Apache-2.0
#include "sand/import/points_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "files/input_error.hpp"
#include "files/trimmed.hpp"

namespace sand {
namespace {

constexpr double kFlat = 1e-9;  // width over length of a cloud that has no area: doubles tell little less

std::vector<std::string_view> fieldsOf(std::string_view text) {
    const bool semicolons = text.find(';') != std::string_view::npos;
    const bool commas = text.find(',') != std::string_view::npos;
    const std::string_view separator = semicolons ? ";" : commas ? "," : " \t";
    std::vector<std::string_view> fields;
    for (;;) {
        const std::size_t end = text.find_first_of(separator);
        fields.push_back(files::trimmed(text.substr(0, end)));
        if (end == std::string_view::npos) {
            return fields;
        }
        text.remove_prefix(end + 1);
        // Blanks in a row are one separator; commas are not.
        text = semicolons || commas ? text : files::trimmed(text);
    }
}

std::optional<double> numberOf(std::string_view field) {
    field.remove_prefix(field.size() > 1 && field.front() == '+' ? 1 : 0);
    double value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || field.empty() || !std::isfinite(value)) {
        return std::nullopt;
    }
    return value;
}

/// Points with the lines they stand in.
class Cloud {
public:
    explicit Cloud(const std::filesystem::path& file) : file_(file.string()) {
        std::error_code ignored;
        std::ifstream stream(file, std::ios::binary);
        if (!stream || std::filesystem::is_directory(file, ignored)) {
            throw files::InputError(file_ + ": cannot be read; check the path");
        }
        bool first = true;
        std::string text;
        for (long line = 1; std::getline(stream, text); ++line) {
            const std::string_view content = files::trimmed(std::string_view(text).substr(0, text.find('#')));
            if (!content.empty()) {
                add(fieldsOf(content), line, std::exchange(first, false));
            }
        }
    }

    /// One of each place.
    [[nodiscard]] Points distinct() const {
        std::vector<std::size_t> order(points_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        // By place, then by line: no two are equal, and so the order is the same everywhere.
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return std::tuple(points_[a][0], points_[a][1], a) < std::tuple(points_[b][0], points_[b][1], b);
        });
        std::vector<bool> repeated(points_.size());
        for (std::size_t i = 1; i < order.size(); ++i) {
            const auto& before = points_[order[i - 1]];
            const auto& point = points_[order[i]];
            if (before[0] != point[0] || before[1] != point[1]) {
                continue;
            }
            if (before[2] != point[2]) {
                fail(lines_[order[i]], fmt::format("x = {}, y = {} has height {}, and {} in line {}; keep one of them",
                                                   point[0], point[1], point[2], before[2], lines_[order[i - 1]]));
            }
            repeated[order[i]] = true;
        }
        Points points;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            if (!repeated[i]) {
                points.push_back(points_[i]);
            }
        }
        return points;
    }

private:
    void add(const std::vector<std::string_view>& fields, long line, bool mayBeTitle) {
        if (mayBeTitle && !numberOf(fields[0])) {
            checkTitle(fields, line);
            return;
        }
        if (fields.size() != 3) {
            fail(line, fmt::format("x, y and z are wanted, got {} values", fields.size()));
        }
        if (points_.size() == kMostPoints) {
            fail(line, fmt::format("more than {} points; thin them out", kMostPoints));
        }
        std::array<double, 3> point{};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::optional<double> value = numberOf(fields[i]);
            if (!value) {
                fail(line, fmt::format("{} must be a finite number, got '{}'", "xyz"[i], fields[i]));
            }
            point.at(i) = *value;
        }
        points_.push_back(point);
        lines_.push_back(line);
    }
    /// A title may call the columns anything, but not x, y or z where that stands in another one.
    void checkTitle(const std::vector<std::string_view>& fields, long line) const {
        for (std::size_t i = 0; i < fields.size(); ++i) {
            const std::string_view name = fields[i];
            const std::size_t axis = name.size() == 1 ? std::string_view("xyzXYZ").find(name.front()) : i;
            if (axis != std::string_view::npos && axis % 3 != i) {
                fail(line, fmt::format("the columns must be x, y, z, and '{}' is number {}", name, i + 1));
            }
        }
        if (fields.size() != 3) {
            fail(line, fmt::format("three columns are wanted, x, y, z, and '{}' begins a title of {}", fields[0],
                                   fields.size()));
        }
    }
    [[noreturn]] void fail(long line, const std::string& message) const {
        throw files::InputError(file_, line, message);
    }

    std::string file_;
    Points points_;
    std::vector<long> lines_;
};

double squaredDistance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]);
}

bool onOneLine(const Points& points) {
    const auto farthest = *std::max_element(points.begin(), points.end(), [&](const auto& a, const auto& b) {
        return squaredDistance(points[0], a) < squaredDistance(points[0], b);
    });
    const double length = squaredDistance(points[0], farthest);
    return std::all_of(points.begin(), points.end(), [&](const auto& point) {
        const double area = (farthest[0] - points[0][0]) * (point[1] - points[0][1]) -
                            (farthest[1] - points[0][1]) * (point[0] - points[0][0]);
        return std::abs(area) <= kFlat * length;
    });
}

}  // namespace

Points readPoints(const std::filesystem::path& file) {
    Points points = Cloud(file).distinct();
    if (points.size() < 3) {
        throw files::InputError(fmt::format("{}: holds {} points at different places, and terrain takes at least 3",
                                            file.string(), points.size()));
    }
    if (onOneLine(points)) {
        throw files::InputError(
            fmt::format("{}: all {} points lie on one line, and terrain needs an area", file.string(), points.size()));
    }
    return points;
}

}  // namespace sand
