// SPDX-License-Identifier: Apache-2.0
#include "scene/import/points_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>

#include "base/input_error.hpp"
#include "base/number.hpp"
#include "base/text.hpp"
#include "base/text_reader.hpp"
#include "scene/import/metric_system.hpp"
#include "scene/import/point_fields.hpp"
#include "scene/import/steady_files.hpp"

namespace scene {
namespace {

constexpr std::string_view kTransform = "gdaltransform -s_srs EPSG:4326 -t_srs EPSG:";
constexpr double kLines = 0.8;  // part of the time that reading the lines takes; sorting the points takes the rest
constexpr double kFlat = 1e-9;  // width / length below which a cloud counts as a line; doubles resolve little more

/// Points with the lines that contain them.
class Cloud {
public:
    /// Calls `done` with the bytes that are read.
    Cloud(const std::filesystem::path& file, const std::function<void(std::uint64_t bytes)>& done)
        : file_(file.string()), style_(file_) {
        std::error_code ignored;
        std::ifstream stream(file, std::ios::binary);
        if (!stream || std::filesystem::is_directory(file, ignored) ||
            std::filesystem::is_character_file(file, ignored)) {  // devices may never end
            throw base::InputError(file_ + ": cannot be read; check the path");
        }
        bool first = true;
        std::uint64_t bytes = 0;
        base::TextReader lines(stream, file_);
        for (std::string_view text; lines.nextLine(text);) {
            const std::string_view content = base::trimmed(text.substr(0, text.find('#')));
            if (!content.empty()) {
                add(pointFieldsOf(content), lines.line(), std::exchange(first, false));
            }
            if (std::exchange(bytes, lines.bytesRead()) != lines.bytesRead()) {
                done(lines.bytesRead());
            }
        }
        if (stream.bad()) {
            throw base::InputError(file_ + ": cannot be read to its end; check the disk it lies on");
        }
    }

    /// Returns one point per place.
    [[nodiscard]] Points distinct() const {
        std::vector<std::size_t> order(points_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        // Sorts by place, then by line. No two are equal, so that the order is the same on every machine.
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
        if (mayBeTitle && !fields[0].empty() && std::none_of(fields.begin(), fields.end(), meansNumber)) {
            readTitle(fields, line);
            return;
        }
        if (fields.size() != 3) {
            fail(line, fmt::format("expected x, y and z, got {} values{}", fields.size(),
                                   fields.size() == 6 ? "; separate numbers with decimal commas by semicolons" : ""));
        }
        if (points_.size() == kMostPoints) {
            fail(line, fmt::format("more than {} points; thin them out", kMostPoints));
        }
        std::array<double, 3> point{};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::string_view field = fields[columns_.at(i)];
            const std::optional<double> value = style_.numberOf(field, line);
            if (!value && isAngle(field)) {
                fail(line,
                     fmt::format("its coordinates ('{}') are degrees, but sand needs lengths; write them as plain "
                                 "decimals, longitude first, and make metres of them: {}CODE, CODE being that of their "
                                 "UTM zone",
                                 field, kTransform));
            }
            if (!value) {
                const bool both =
                    field.find('.') != std::string_view::npos && field.find(',') != std::string_view::npos;
                fail(line, fmt::format("{} must be a finite number, got '{}'{}", "xyz"[i], field,
                                       both ? "; leave separators of thousands out" : ""));
            }
            point.at(i) = *value;
        }
        if (degrees_) {
            failForDegrees(point);
        }
        points_.push_back(point);
        lines_.push_back(line);
    }
    /// Reads a title. It may name the columns freely, but x, y and z only where they belong. Names such as northing may
    /// be in any order.
    void readTitle(const std::vector<std::string_view>& fields, long line) {
        if (fields.size() != 3) {
            const auto degrees = std::find_if(fields.begin(), fields.end(), isDegrees);
            fail(line, fmt::format("expected three columns x, y, z, but '{}' begins a title of {}{}", fields[0],
                                   fields.size(),
                                   degrees == fields.end() ? "; leave other columns out"
                                                           : fmt::format("; '{}' is in degrees, but sand needs lengths",
                                                                         base::unquoted(*degrees))));
        }
        for (const std::string_view name : {fields[0], fields[1]}) {
            if (isDegrees(name) && !degrees_) {
                degrees_ = Degrees{std::string(base::unquoted(name)), line, isLatitude(fields[0])};
            }
        }
        if (!degrees_) {
            orderColumns(fields, line);
        }
    }
    /// Sets columns_ by the names in a title. Names that tell nothing keep their place.
    void orderColumns(const std::vector<std::string_view>& fields, long line) {
        constexpr std::size_t kUnknown = 3;
        std::array<std::size_t, 3> axis{};  // of each column
        std::array<bool, 3> taken{};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::string_view name = base::unquoted(fields[i]);
            const std::vector<std::size_t> axes = axesOf(name);
            axis.at(i) = axes.empty() ? kUnknown : axes[0];
            if (axes.size() == 1 && axes[0] != i && isLettered(name)) {
                fail(line, fmt::format("the columns must be x, y, z, and '{}' is number {}", name, i + 1));
            }
            if (axes.size() > 1 || (!axes.empty() && std::exchange(taken.at(axes[0]), true))) {
                failForNames(fields, line);
            }
        }
        for (std::size_t i = 0; i < 3; ++i) {
            if (axis.at(i) == kUnknown) {
                // A name that tells nothing stands for its own place, or for the only one that is left.
                const auto left =
                    static_cast<std::size_t>(std::find(taken.begin(), taken.end(), false) - taken.begin());
                const bool only = std::count(taken.begin(), taken.end(), false) == 1;
                if (taken.at(i) && !only) {
                    failForNames(fields, line);
                }
                axis.at(i) = taken.at(i) ? left : i;
                taken.at(axis.at(i)) = true;
            }
        }
        for (std::size_t i = 0; i < 3; ++i) {
            columns_.at(axis.at(i)) = i;
        }
    }
    [[noreturn]] void failForNames(const std::vector<std::string_view>& fields, long line) const {
        fail(line, fmt::format("the columns '{}', '{}' and '{}' can be read in several orders; name them x, y, z, from "
                               "west to east, from south to north, and up",
                               base::unquoted(fields[0]), base::unquoted(fields[1]), base::unquoted(fields[2])));
    }
    /// Throws base::InputError with the command that converts degrees to metres, in the UTM zone of the first point.
    [[noreturn]] void failForDegrees(const std::array<double, 3>& point) const {
        const std::size_t north = degrees_->latitudeFirst ? 0 : 1;
        fail(degrees_->line,
             fmt::format(
                 "its coordinates ('{}') are degrees, but sand needs lengths; make metres of lines of longitude, "
                 "latitude and height: {}{}",
                 degrees_->name, kTransform, metricSystemAt(point.at(1 - north), point.at(north))));
    }
    [[noreturn]] void fail(long line, const std::string& message) const {
        throw base::InputError(file_, line, message);
    }

    /// Columns in degrees, as the title names them.
    struct Degrees {
        std::string name;
        long line = 0;
        bool latitudeFirst = false;
    };

    std::string file_;
    base::DecimalStyle style_;
    std::array<std::size_t, 3> columns_{0, 1, 2};  // of x, y and z
    Points points_;
    std::vector<long> lines_;
    std::optional<Degrees> degrees_;
};

using Wide = long double;  // squares of doubles neither overflow nor vanish in it

Wide squaredDistance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    const Wide x = Wide{a[0]} - b[0], y = Wide{a[1]} - b[1];
    return x * x + y * y;
}

bool onOneLine(const Points& points) {
    const auto farthest = *std::max_element(points.begin(), points.end(), [&](const auto& a, const auto& b) {
        return squaredDistance(points[0], a) < squaredDistance(points[0], b);
    });
    const Wide length = squaredDistance(points[0], farthest);
    return std::all_of(points.begin(), points.end(), [&](const auto& point) {
        const Wide area = (Wide{farthest[0]} - points[0][0]) * (Wide{point[1]} - points[0][1]) -
                          (Wide{farthest[1]} - points[0][1]) * (Wide{point[0]} - points[0][0]);
        return std::abs(area) <= kFlat * length;
    });
}

}  // namespace

Points readPoints(const std::filesystem::path& file, const std::function<void(double share)>& done) {
    const auto report = [&](double share) {
        if (done) {
            done(share);
        }
    };
    std::error_code unknown;  // of a pipe, for example
    const auto size = static_cast<double>(std::filesystem::file_size(file, unknown));
    Points points = SteadyFiles({file}).read([&] {
        const Cloud cloud(file, [&](std::uint64_t bytes) {
            report(unknown ? 0 : std::min(kLines * static_cast<double>(bytes) / size, kLines));
        });
        report(kLines);
        return cloud.distinct();
    });
    report(1);
    if (points.size() < 3) {
        throw base::InputError(fmt::format("{}: holds {} points at different places, but terrain needs at least 3",
                                           file.string(), points.size()));
    }
    if (onOneLine(points)) {
        throw base::InputError(
            fmt::format("{}: all {} points lie on one line, but terrain needs an area", file.string(), points.size()));
    }
    return points;
}

}  // namespace scene
