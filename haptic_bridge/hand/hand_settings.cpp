// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/hand_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/input_error.hpp"
#include "base/number.hpp"

namespace haptic_bridge {
namespace {

/// One --map option.
struct Option {
    std::string text;
    std::string_view key, value;

    [[noreturn]] void fail(const std::string& what) const {
        throw base::InputError(fmt::format("--map {}: {}", text, what));
    }

    [[nodiscard]] double number(std::string_view word) const {
        const std::optional<double> result = base::numberOf(word);
        if (!result) {
            fail(fmt::format("'{}' is not a number", word));
        }
        return *result;
    }
    [[nodiscard]] double positive(std::string_view word) const {
        const double result = number(word);
        if (!(result > 0)) {
            fail("must be positive");
        }
        return result;
    }
    [[nodiscard]] std::vector<std::string_view> words(std::size_t count) const {
        std::vector<std::string_view> result;
        for (std::size_t begin = 0; begin <= value.size();) {
            const std::size_t end = std::min(value.find(',', begin), value.size());
            result.push_back(value.substr(begin, end - begin));
            begin = end + 1;
        }
        if (result.size() != count || std::any_of(result.begin(), result.end(), [](auto w) { return w.empty(); })) {
            fail(fmt::format("needs {} values, separated by commas", count));
        }
        return result;
    }
};

void readAxes(const Option& option, HandSettings& settings) {
    std::array<bool, 3> used{};
    const auto words = option.words(3);
    for (std::size_t i = 0; i < 3; ++i) {
        std::string_view word = words[i];
        const double sign = word.starts_with('-') ? -1 : 1;
        if (word.starts_with('-') || word.starts_with('+')) {
            word.remove_prefix(1);
        }
        if (word.size() != 1 || word[0] < 'x' || word[0] > 'z' || used[static_cast<std::size_t>(word[0] - 'x')]) {
            option.fail("give east, north and up as x, y and z, each once; '-' reverses an axis");
        }
        used[static_cast<std::size_t>(word[0] - 'x')] = true;
        settings.axes[i] = {word[0] - 'x', sign};
    }
}

void readTime(const Option& option, HandSettings& settings) {
    constexpr std::array<std::pair<std::string_view, double>, 4> units{
        {{"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}}};
    const auto* unit = std::find_if(units.begin(), units.end(), [&](const auto& u) { return u.first == option.value; });
    if (unit == units.end()) {
        option.fail("must be s, ms, us or ns");
    }
    settings.secondsPerTick = unit->second;
}

void readEngage(const Option& option, HandSettings& settings) {
    if (option.value == "near") {
        settings.engage = HandSettings::Engage::near;
    } else if (option.value == "always") {
        settings.engage = HandSettings::Engage::always;
    } else if (option.value == "button") {
        settings.engage = HandSettings::Engage::button;
    } else {
        option.fail("must be near, always or button");
    }
}

void apply(const Option& option, HandSettings& settings) {
    const auto either = [&option](std::string_view first, std::string_view second) {
        if (option.value != first && option.value != second) {
            option.fail(fmt::format("must be {} or {}", first, second));
        }
        return option.value == first;
    };
    if (option.key == "columns") {
        const auto words = option.words(4);
        std::copy(words.begin(), words.end(), settings.columns.begin());
    } else if (option.key == "time") {
        readTime(option, settings);
    } else if (option.key == "axes") {
        readAxes(option, settings);
    } else if (option.key == "scale") {
        settings.scale = option.value == "auto" ? std::nullopt : std::optional(option.positive(option.value));
    } else if (option.key == "vertical") {
        settings.verticalScale = option.positive(option.value);
    } else if (option.key == "origin") {
        const auto words = option.words(3);
        settings.origin = {option.number(words[0]), option.number(words[1]), option.number(words[2])};
    } else if (option.key == "depth") {
        settings.depth = option.number(option.value);
    } else if (option.key == "drift") {
        settings.drift = option.number(option.value);
        if (!(settings.drift >= 0 && settings.drift <= 1)) {
            option.fail("must be between 0 and 1");
        }
    } else if (option.key == "engage") {
        readEngage(option, settings);
    } else if (option.key == "datum") {
        settings.datum = either("surface", "level") ? HandSettings::Datum::surface : HandSettings::Datum::level;
    } else {
        option.fail("the keys are columns, time, axes, scale, vertical, origin, depth, drift, engage and datum");
    }
}

}  // namespace

HandSettings HandSettings::parse(const std::vector<std::string>& options) {
    HandSettings settings;
    for (const std::string& text : options) {
        const auto equals = text.find('=');
        Option option{text, {}, {}};
        if (equals == std::string::npos) {
            option.fail("write KEY=VALUE");
        }
        option.key = std::string_view(option.text).substr(0, equals);
        option.value = std::string_view(option.text).substr(equals + 1);
        apply(option, settings);
    }
    return settings;
}

}  // namespace haptic_bridge
