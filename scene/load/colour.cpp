// SPDX-License-Identifier: Apache-2.0
#include "scene/load/colour.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

namespace scene {
namespace {

/// Returns the linear light of a level of sRGB, 0 to 255 (IEC 61966-2-1).
double linearOf(int level) {
    const double value = level / 255.0;
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

std::vector<double> parseColour(const host::TomlTable& table, std::string_view key) {
    const std::string text = table.text(key);
    std::vector<double> colour;
    for (std::size_t at = 1; text.size() == 7 && text[0] == '#' && at < text.size(); at += 2) {
        int level = 0;
        const char* const end = text.data() + at + 2;
        if (std::from_chars(text.data() + at, end, level, 16).ptr != end || level < 0) {
            break;
        }
        colour.push_back(linearOf(level));
    }
    if (colour.size() != 3) {
        table.fail(key, fmt::format("{} must be a colour such as \"#c8b48c\", or three numbers from 0 to 1, got '{}'",
                                    key, text.substr(0, 80)));
    }
    return colour;
}

}  // namespace

std::vector<double> colourOr(const host::TomlTable& table, std::string_view key, std::vector<double> fallback) {
    if (!table.has(key)) {
        return fallback;
    }
    if (table.isText(key)) {
        return parseColour(table, key);
    }
    std::vector<double> colour = table.numbers(key, 3);
    const auto wrong = std::find_if(colour.begin(), colour.end(), [](double part) { return part < 0 || part > 1; });
    if (wrong != colour.end()) {
        const bool levels = *wrong > 1 && std::all_of(colour.begin(), colour.end(),
                                                      [](double part) { return part >= 0 && part <= 255; });
        table.fail(key, fmt::format("{} must be three numbers from 0 to 1, got {}{}", key, *wrong,
                                    levels ? "; divide by 255" : ""));
    }
    return colour;
}

}  // namespace scene
