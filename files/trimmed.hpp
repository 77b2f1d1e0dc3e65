// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace files {

/// A part of a line without the blanks around it: spaces, tabs, and what other systems end lines with.
[[nodiscard]] constexpr std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlanks = " \t\r";
    const auto begin = text.find_first_not_of(kBlanks);
    return begin == std::string_view::npos ? std::string_view{}
                                           : text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

}  // namespace files
