// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/devices/trace.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string_view>

#include "base/input_error.hpp"
#include "base/text.hpp"

namespace haptic_bridge {
namespace {

constexpr double kTracedShare = 0.8;  // of the field that a trace without a scale covers
constexpr double kLargest = 1e12;     // largest time or coordinate

std::optional<double> boundedNumber(std::string_view word) {
    const std::optional<double> value = base::numberOf(word);
    return value && std::abs(*value) <= kLargest ? value : std::nullopt;
}

/// Returns a date such as "2023/09/05/19:18:29.980002" as seconds since 1970; nullopt if `word` is not a date.
std::optional<double> dateOf(std::string_view word) {
    constexpr std::string_view form = "dddd/dd/dd/dd:dd:";
    if (word.size() < form.size()) {
        return std::nullopt;
    }
    for (std::size_t i = 0; i < form.size(); ++i) {
        const bool digit = word[i] >= '0' && word[i] <= '9';
        if (form[i] == 'd' ? !digit : word[i] != form[i]) {
            return std::nullopt;
        }
    }
    const auto part = [&](std::size_t begin, std::size_t count) {
        return static_cast<int>(boundedNumber(word.substr(begin, count)).value_or(0));
    };
    const std::chrono::year_month_day day{std::chrono::year(part(0, 4)),
                                          std::chrono::month(static_cast<unsigned>(part(5, 2))),
                                          std::chrono::day(static_cast<unsigned>(part(8, 2)))};
    const auto seconds = boundedNumber(word.substr(form.size()));
    if (!day.ok() || part(11, 2) > 23 || part(14, 2) > 59 || !seconds || *seconds < 0 || *seconds >= 61) {
        return std::nullopt;
    }
    const auto days = std::chrono::sys_days(day).time_since_epoch().count();
    return static_cast<double>(days) * 86400.0 + part(11, 2) * 3600 + part(14, 2) * 60 + *seconds;
}

/// Returns the indices of the columns that hold time, x, y and z.
std::array<std::size_t, 4> findColumns(std::string_view header, const std::string& name, const HandSettings& settings) {
    const auto titles = base::split(header, ',');
    std::array<std::size_t, 4> found{};
    for (std::size_t i = 0; i < found.size(); ++i) {
        const auto title = std::find(titles.begin(), titles.end(), settings.columns[i]);
        if (title == titles.end()) {
            throw base::InputError(name, 1,
                                   "no column '" + settings.columns[i] + "' in the header '" +
                                       std::string(header.substr(0, 80)) +
                                       "'; name the columns with --map columns=TIME,X,Y,Z");
        }
        found[i] = static_cast<std::size_t>(title - titles.begin());
    }
    return found;
}

/// Reads one line after another. The first line decides which form of time the trace has.
class SampleReader {
public:
    SampleReader(const std::string& name, const HandSettings& settings, std::array<std::size_t, 4> columns)
        : name_(name), settings_(settings), columns_(columns) {}

    [[nodiscard]] Trace::Sample read(std::string_view line, long number) {
        const auto cells = base::split(line, ',');
        const std::size_t needed = *std::max_element(columns_.begin(), columns_.end()) + 1;
        if (cells.size() < needed) {
            throw base::InputError(name_, number,
                                   std::to_string(needed) + " values expected, got " + std::to_string(cells.size()));
        }
        Trace::Sample sample;
        sample.time = time(cells[columns_[0]], number);
        for (std::size_t i = 0; i < 3; ++i) {
            const auto value = boundedNumber(cells[columns_[i + 1]]);
            if (!value) {
                throw base::InputError(
                    name_, number,
                    settings_.columns[i + 1] + " is not a number: '" + std::string(cells[columns_[i + 1]]) + "'");
            }
            sample.place[i] = *value;
        }
        return sample;
    }

private:
    [[nodiscard]] double time(std::string_view word, long number) {
        const auto date = dateOf(word);
        const auto ticks = date ? std::nullopt : boundedNumber(word);
        if (!date && !ticks) {
            throw base::InputError(
                name_, number, "time is neither a number nor YYYY/MM/DD/HH:MM:SS.ffffff: '" + std::string(word) + "'");
        }
        const double now = date ? *date : *ticks * settings_.secondsPerTick;
        if (!first_) {
            first_ = now;
        }
        const double elapsed = now - *first_;
        if (elapsed < last_) {
            throw base::InputError(name_, number, "time runs backwards: '" + std::string(word) + "'");
        }
        return last_ = elapsed;
    }

    const std::string& name_;
    const HandSettings& settings_;
    std::array<std::size_t, 4> columns_;
    std::optional<double> first_;
    double last_ = 0;
};

}  // namespace

Trace Trace::parse(std::istream& text, const std::string& name, const HandSettings& settings) {
    std::string line;
    if (!std::getline(text, line)) {
        throw base::InputError(name, 1, "the trace is empty; a header such as time,x,y,z comes first");
    }
    SampleReader reader(name, settings, findColumns(line, name, settings));
    Trace trace;
    long number = 1;
    while (std::getline(text, line)) {
        ++number;
        if (!line.empty() && line != "\r") {
            trace.samples.push_back(reader.read(line, number));
        }
    }
    if (trace.samples.size() < 2) {
        throw base::InputError(name, number,
                               "a trace needs at least two samples, got " + std::to_string(trace.samples.size()));
    }
    return trace;
}

TraceDevice::TraceDevice(const Trace& trace, const HandSettings& settings, double fieldWidth, double fieldHeight,
                         double toolRadius)
    : settings_(settings) {
    std::vector<double> east, north, up;
    for (const Trace::Sample& sample : trace.samples) {
        const auto along = [&](const HandSettings::Axis& axis) {
            return axis.sign * sample.place[static_cast<std::size_t>(axis.column)];
        };
        const sand::force::Vec3 place{along(settings.axes[0]), along(settings.axes[1]), along(settings.axes[2])};
        knots_.push_back({sample.time, place});
        east.push_back(place.x);
        north.push_back(place.y);
        up.push_back(place.z);
    }
    const auto [west, eastmost] = std::minmax_element(east.begin(), east.end());
    const auto [south, northmost] = std::minmax_element(north.begin(), north.end());
    const double width = *eastmost - *west, height = *northmost - *south;
    const auto middle = up.begin() + static_cast<std::ptrdiff_t>(up.size() / 2);
    std::nth_element(up.begin(), middle, up.end());
    origin_ = settings.origin.value_or(sand::force::Vec3{(*west + *eastmost) / 2, (*south + *northmost) / 2, *middle});
    double scale = settings.scale.value_or(
        kTracedShare * std::min(fieldWidth / std::max(width, 1e-9), fieldHeight / std::max(height, 1e-9)));
    // A hand that never moved sideways has no size that could be fitted to the field.
    scale = !settings.scale && width <= 0 && height <= 0 ? 1 : scale;
    horizontal_ = scale / (std::min(fieldWidth, fieldHeight) / 2);
    vertical_ = scale * settings.verticalScale / std::max(toolRadius, 1e-12);
}

Pose TraceDevice::read(double time) {
    while (next_ + 1 < knots_.size() && knots_[next_].time < time) {
        ++next_;
    }
    const Knot& from = knots_[next_ - 1];
    const Knot& to = knots_[next_];
    const double span = to.time - from.time;
    const double share = span > 0 ? std::clamp((time - from.time) / span, 0.0, 1.0) : 1.0;
    const sand::force::Vec3 place = from.place + share * (to.place - from.place) - origin_;
    Pose pose{place.x * horizontal_, place.y * horizontal_, 1 - settings_.depth.value_or(0.5) + place.z * vertical_,
              false};
    const double underside = pose.z - 1;  // [tool radius] above the surface
    pose.engaged = !finished(time) && (settings_.engage == HandSettings::Engage::always || underside < 1);
    return pose;
}

}  // namespace haptic_bridge
