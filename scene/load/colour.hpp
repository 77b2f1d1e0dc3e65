// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "host/toml_table.hpp"

namespace scene {

/// Returns a colour as linear-light RGB, each from 0 to 1. The key holds a list of three such numbers, or a text
/// "#rrggbb" with the levels of sRGB as image programs write them. Returns `fallback` if the key is absent. Throws
/// base::InputError.
[[nodiscard]] std::vector<double> colourOr(const host::TomlTable& table, std::string_view key,
                                           std::vector<double> fallback);

}  // namespace scene
