// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace tracking {

/// The parts of a text between separators, spaces around them taken off; an empty text is one empty part.
[[nodiscard]] std::vector<std::string_view> split(std::string_view text, char separator);
/// The whole word as a finite number.
[[nodiscard]] std::optional<double> numberOf(std::string_view word);

}  // namespace tracking
