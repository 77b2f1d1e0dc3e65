// SPDX-License-Identifier: Apache-2.0
#include "tracking/words.hpp"

#include <charconv>
#include <cmath>

namespace tracking {
namespace {

std::string_view trimmed(std::string_view word) {
    constexpr std::string_view kBlanks = " \t\r";
    const auto begin = word.find_first_not_of(kBlanks);
    return begin == std::string_view::npos ? std::string_view{}
                                           : word.substr(begin, word.find_last_not_of(kBlanks) - begin + 1);
}

}  // namespace

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    while (true) {
        const auto end = text.find(separator);
        parts.push_back(trimmed(text.substr(0, end)));
        if (end == std::string_view::npos) {
            return parts;
        }
        text.remove_prefix(end + 1);
    }
}

std::optional<double> numberOf(std::string_view word) {
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool whole = error == std::errc{} && end == word.data() + word.size();
    return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

}  // namespace tracking
