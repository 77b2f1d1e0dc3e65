// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/devices/trace.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>

#include "base/input_error.hpp"
#include "base/number.hpp"
#include "base/text.hpp"
#include "base/text_reader.hpp"

namespace haptic_bridge {
namespace {

constexpr double kTracedShare = 0.8;  // of the field that a trace without a scale covers
constexpr double kLargest = 1e12;     // largest coordinate
constexpr double kLatest = 1e11;      // [s]; a larger time is in a smaller unit. Now is 2e9 s after 1970
constexpr double kLongest = 1e9;      // [s], most seconds between the first and the last sample

/// A time in whole ticks and a rest. In nanoseconds since 1970 a double would be off by a quarter of a microsecond.
struct Ticks {
    std::int64_t whole = 0;
    double rest = 0;

    [[nodiscard]] double since(const Ticks& first) const {
        return static_cast<double>(whole - first.whole) + (rest - first.rest);
    }
};

/// Returns the ticks of a number that `word` spells as `value`.
Ticks ticksOf(std::string_view word, double value) {
    const std::size_t digits = std::min(word.find_first_not_of("0123456789"), word.size());
    Ticks ticks;
    const auto [end, error] = std::from_chars(word.data(), word.data() + digits, ticks.whole);
    const std::string_view rest = word.substr(digits);
    if (digits == 0 || error != std::errc{} || rest.find_first_of("eE") != std::string_view::npos) {
        return {0, value};  // negative, or with an exponent
    }
    std::string fraction(1, '0');
    fraction += rest;
    std::replace(fraction.begin(), fraction.end(), ',', '.');
    ticks.rest = base::numberOf(fraction).value_or(0);
    return ticks;
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
        return static_cast<int>(base::numberOf(word.substr(begin, count)).value_or(0));
    };
    const std::chrono::year_month_day day{std::chrono::year(part(0, 4)),
                                          std::chrono::month(static_cast<unsigned>(part(5, 2))),
                                          std::chrono::day(static_cast<unsigned>(part(8, 2)))};
    const auto seconds = base::numberOf(word.substr(form.size()));
    if (!day.ok() || part(11, 2) > 23 || part(14, 2) > 59 || !seconds || *seconds < 0 || *seconds >= 61) {
        return std::nullopt;
    }
    const auto days = std::chrono::sys_days(day).time_since_epoch().count();
    return static_cast<double>(days) * 86400.0 + part(11, 2) * 3600 + part(14, 2) * 60 + *seconds;
}

/// Returns the indices of the columns that hold time, x, y and z.
std::array<std::size_t, 4> findColumns(std::string_view header, char separator, const std::string& name,
                                       const HandSettings& settings) {
    auto titles = base::split(header, separator);
    std::transform(titles.begin(), titles.end(), titles.begin(), base::unquoted);
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
    SampleReader(const std::string& name, const HandSettings& settings, std::string_view header)
        : name_(name),
          settings_(settings),
          separator_(base::separatorOf(header)),
          columns_(findColumns(header, separator_, name, settings)),
          style_(name) {}

    [[nodiscard]] Trace::Sample read(std::string_view line, long number) {
        const auto cells = base::split(line, separator_);
        const std::size_t needed = *std::max_element(columns_.begin(), columns_.end()) + 1;
        if (cells.size() < needed) {
            throw base::InputError(name_, number,
                                   std::to_string(needed) + " values expected, got " + std::to_string(cells.size()));
        }
        Trace::Sample sample;
        sample.time = time(cells[columns_[0]], number);
        for (std::size_t i = 0; i < 3; ++i) {
            const auto value = style_.numberOf(cells[columns_[i + 1]], number);
            if (!value || std::abs(*value) > kLargest) {
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
        const double elapsed = elapsedAt(word, number);
        if (elapsed < last_) {
            throw base::InputError(name_, number, "time runs backwards: '" + std::string(word) + "'");
        }
        if (elapsed > kLongest) {
            throw base::InputError(
                name_, number, "time jumps: '" + std::string(word) + "' is more than 30 years after the first sample");
        }
        return last_ = elapsed;
    }
    /// Returns the time since the first sample [s].
    [[nodiscard]] double elapsedAt(std::string_view word, long number) {
        if (const auto date = dateOf(word)) {
            firstDate_ = firstDate_.value_or(*date);
            return *date - *firstDate_;
        }
        const auto value = style_.numberOf(word, number);
        if (!value) {
            throw base::InputError(
                name_, number, "time is neither a number nor YYYY/MM/DD/HH:MM:SS.ffffff: '" + std::string(word) + "'");
        }
        if (std::abs(*value) * settings_.secondsPerTick > kLatest) {
            throw base::InputError(
                name_, number,
                "time '" + std::string(word) +
                    "' would be thousands of years after 1970; give its unit: --map time=ms, us or ns");
        }
        const Ticks ticks = ticksOf(word, *value);
        firstTicks_ = firstTicks_.value_or(ticks);
        return ticks.since(*firstTicks_) * settings_.secondsPerTick;
    }

    const std::string& name_;
    const HandSettings& settings_;
    char separator_;
    std::array<std::size_t, 4> columns_;
    base::DecimalStyle style_;
    std::optional<double> firstDate_;  // [s] since 1970
    std::optional<Ticks> firstTicks_;
    double last_ = 0;
};

}  // namespace

Trace Trace::parse(std::istream& text, const std::string& name, const HandSettings& settings) {
    base::TextReader lines(text, name);
    std::string_view line;
    if (!lines.nextLine(line)) {
        lines.fail("the trace is empty; a header such as time,x,y,z comes first");
    }
    SampleReader reader(name, settings, line);
    Trace trace;
    while (lines.nextLine(line)) {
        if (!base::trimmed(line).empty()) {
            trace.samples.push_back(reader.read(line, lines.line()));
        }
    }
    if (trace.samples.size() < 2) {
        lines.fail("a trace needs at least two samples, got " + std::to_string(trace.samples.size()));
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
