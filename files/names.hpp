// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "files/input_error.hpp"

namespace files {

/// Which of `names` it is. Throws InputError, "no WHAT 'name'; there are …", for another.
template <std::size_t kCount>
[[nodiscard]] std::size_t indexOf(std::string_view name, const std::array<std::string_view, kCount>& names,
                                  std::string_view what) {
    std::string known;
    for (std::size_t i = 0; i < kCount; ++i) {
        if (names[i] == name) {
            return i;
        }
        known.append(i == 0 ? "" : ", ").append(names[i]);
    }
    throw InputError("no " + std::string(what) + " '" + std::string(name) + "'; there are " + known);
}

}  // namespace files
