// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "render_node/overlay/letters.hpp"
#include "walls/wall.hpp"

namespace render_node {

/// Entry of the help: a button or keys, and their effect.
struct HelpEntry {
    std::string keys, effect;
};
/// Returns the uses of the mouse and all keys that windows obey (lockstep::keyList()).
[[nodiscard]] std::vector<HelpEntry> helpEntries();

/// Place of a tile in the lowest row of the wall, where people look for the help.
struct HelpPlace {
    int index = 0, count = 1;  // among the tiles of this row
    glm::ivec2 smallest{0};    // [pixel], the smallest sides of these tiles
};
/// Returns the place of a tile in the lowest row of `wall`, or nullopt if it is in another row. An explicit screen is
/// in the lowest row if its lower edge is as low as that of any explicit screen, and the wall has no grid.
[[nodiscard]] std::optional<HelpPlace> helpPlaceOf(const walls::Wall& wall, const walls::Tile& tile);

/// Returns the help for a tile: a bar as wide as the tile, with the entries in columns, at most seven tenths of the
/// tile high. If the tiles of the row are too small for all entries in letters of 13 pixels, each shows its share of
/// them. Otherwise the bar takes up to the whole tile, or has smaller letters. The smallest tiles show the first
/// entries. All bars of a row with tiles of one size have the same height.
[[nodiscard]] Sheet helpSheet(const HelpPlace& place, glm::ivec2 tile /* [pixel] */);

/// Returns an answer for a tile: a box with one line of text.
[[nodiscard]] Sheet answerSheet(glm::ivec2 tile /* [pixel] */, const std::string& text);
/// Returns the place of an answer on a tile: in the middle, above the help, whose height is `below` [pixel].
[[nodiscard]] glm::ivec2 answerCorner(glm::ivec2 tile /* [pixel] */, glm::ivec2 answer /* [pixel] */, int below);

}  // namespace render_node
