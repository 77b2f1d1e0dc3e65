// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "base/text.hpp"

namespace lockstep {

/// Picture that a wall shows instead of the sand while a person adjusts it (docs/test_patterns.md). ViewState::pattern
/// holds its number. This header needs no OpenGL.
enum class Pattern : std::uint8_t {
    none,
    grid,   // grid and circles in the plane of the wall; they continue behind the bezels
    tiles,  // rank, host, row, column and eye on each tile
    eyes,   // L in red for the left eye, R in cyan for the right
    flash,  // one of four colours, and the number of the frame
    ramp    // grey steps with their levels
};
inline constexpr Pattern kLastPattern = Pattern::ramp;

inline constexpr std::array<std::string_view, 6> kPatternNames{"none", "grid", "tiles", "eyes", "flash", "ramp"};

[[nodiscard]] constexpr std::string_view patternName(Pattern pattern) {
    return kPatternNames.at(static_cast<std::size_t>(pattern));
}

/// Returns the pattern with the name `name`. Throws base::InputError, which lists all names, if there is no such
/// pattern.
[[nodiscard]] inline Pattern parsePattern(std::string_view name) {
    return static_cast<Pattern>(base::indexOf(name, kPatternNames, "test pattern"));
}

/// Returns the pattern after `pattern`, in the order in which a key steps through them. Returns Pattern::none after the
/// last one.
[[nodiscard]] constexpr Pattern nextPattern(Pattern pattern) {
    return pattern == kLastPattern ? Pattern::none : static_cast<Pattern>(static_cast<std::uint8_t>(pattern) + 1);
}

/// Returns whether two frames with the same pattern show different pictures.
[[nodiscard]] constexpr bool changesEveryFrame(Pattern pattern) { return pattern == Pattern::flash; }

}  // namespace lockstep
