// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace base {

/// Reads the number at the begin of `text`, in any locale, also an infinite one or nan. Returns how many characters
/// spell it. Returns 0 if no number is there, or if the number is too large for a double. All decimal numbers of the
/// project are read here, because the libraries of some compilers have no std::from_chars for double.
[[nodiscard]] std::size_t readNumber(std::string_view text, double& value);

/// Returns the number that the whole of `word` spells, in any locale. A sign may be + or -. Returns nullopt if it
/// spells no finite number.
[[nodiscard]] std::optional<double> numberOf(std::string_view word);

/// Returns the number that `word` spells with a decimal comma, such as 1.5 for "1,5". Returns nullopt without a comma.
[[nodiscard]] std::optional<double> commaNumberOf(std::string_view word);

/// Returns whether `word` means "not a number" as programs print it: nan, -NaN, nan(0x1), 1.#QNAN, -1.#IND.
[[nodiscard]] bool spellsNan(std::string_view word);

/// Reads the numbers of one file whose separator is not the comma. They all have a decimal point, or all a decimal
/// comma: with both, a comma could also separate thousands.
class DecimalStyle {
public:
    explicit DecimalStyle(std::string file) : file_(std::move(file)) {}
    /// Returns the finite number that `word` spells, or nullopt. Throws InputError if the word has a decimal comma and
    /// an earlier one a decimal point, or the other way round.
    [[nodiscard]] std::optional<double> numberOf(std::string_view word, long line);

private:
    struct Seen {
        std::string word;
        long line = 0;
    };
    void refuseBoth(const Seen& comma, const Seen& point, long line) const;

    std::string file_;
    std::optional<Seen> comma_, point_;  // first word of each kind
};

}  // namespace base
