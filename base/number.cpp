// SPDX-License-Identifier: Apache-2.0
#include "base/number.hpp"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "base/input_error.hpp"
#include "base/text.hpp"

namespace base {
namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

std::size_t readNumber(std::string_view text, double& value) {
    const auto [end, error] = fast_float::from_chars(text.data(), text.data() + text.size(), value);
    const auto length = static_cast<std::size_t>(end - text.data());
    // Some versions of fast_float read a number that is too large as infinity, without an error.
    const bool tooLarge = std::isinf(value) && std::any_of(text.data(), end, isDigit);
    return error == std::errc{} && !tooLarge ? length : 0;
}

std::optional<double> numberOf(std::string_view word) {
    // fast_float reads the minus sign alone, as std::from_chars does.
    const bool plus = word.size() > 1 && word.front() == '+' && word[1] != '-';
    word.remove_prefix(plus ? 1 : 0);
    double value = 0;
    const bool whole = !word.empty() && readNumber(word, value) == word.size();
    return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<double> commaNumberOf(std::string_view word) {
    const std::size_t comma = word.find(',');
    // Between digits alone: ",5" and "5," are more often an empty cell beside a separator.
    const bool inside = comma != std::string_view::npos && comma > 0 && comma + 1 < word.size() &&
                        isDigit(word[comma - 1]) && isDigit(word[comma + 1]);
    if (!inside || word.find('.') != std::string_view::npos) {
        return std::nullopt;
    }
    std::string point(word);
    point[comma] = '.';
    return numberOf(point);
}

bool spellsNan(std::string_view word) {
    word.remove_prefix(!word.empty() && (word.front() == '-' || word.front() == '+') ? 1 : 0);
    const std::string lower = lowerCase(word);
    const bool withBits = lower.starts_with("nan(") && lower.back() == ')';
    constexpr std::string_view kWindows = "1.#";  // of Microsoft's older C libraries
    return lower == "nan" || withBits ||
           (lower.starts_with(kWindows) &&
            (lower.find("nan") == kWindows.size() + 1 || lower.find("ind") == kWindows.size() ||
             lower.find("nan") == kWindows.size()));
}

std::optional<double> DecimalStyle::numberOf(std::string_view word, long line) {
    if (const std::optional<double> value = base::numberOf(word)) {
        if (!point_ && word.find('.') != std::string_view::npos) {
            point_ = Seen{std::string(word), line};
        }
        if (comma_ && point_) {
            refuseBoth(*comma_, *point_, line);
        }
        return value;
    }
    const std::optional<double> value = commaNumberOf(word);
    if (value) {
        if (!comma_) {
            comma_ = Seen{std::string(word), line};
        }
        if (point_) {
            refuseBoth(*comma_, *point_, line);
        }
    }
    return value;
}

void DecimalStyle::refuseBoth(const Seen& comma, const Seen& point, long line) const {
    throw InputError(file_, line,
                     "'" + comma.word + "' in line " + std::to_string(comma.line) + " has a decimal comma, and '" +
                         point.word + "' in line " + std::to_string(point.line) +
                         " a decimal point, so that the comma could separate thousands; write decimal points in all "
                         "numbers");
}

}  // namespace base
