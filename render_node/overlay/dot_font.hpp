// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <array>
#include <cstdint>

namespace render_node {

inline constexpr int kGlyphWidth = 5, kGlyphHeight = 7;  // [dot]
inline constexpr int kGlyphPitch = kGlyphWidth + 1;      // from one letter to the next [dot]

/// Returns the rows of a letter from the top. Each row has five dots, the highest bit on the left. Lower-case letters
/// look like capitals. A character that the font lacks is an empty box.
[[nodiscard]] std::array<std::uint8_t, kGlyphHeight> glyphOf(char letter);

}  // namespace render_node
