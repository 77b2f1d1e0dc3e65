// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "render_node/gl/eye_target.hpp"
#include "render_node/gl/pixel_rect.hpp"
#include "render_node/overlay/flat_painter.hpp"

namespace render_node {

/// Entry of the help: a button or key, and its effect.
struct HelpEntry {
    std::string_view key, effect;
};
/// Returns the entries for a session whose hand is the pointer (docs/pointer.md).
[[nodiscard]] std::span<const HelpEntry> pointerHelp();

/// Place of the help on a tile: a bar along the lower edge, with as many lines as the entries need.
struct HelpLayout {
    int dot = 1;  // size of a letter's dot [pixel]
    std::vector<glm::ivec2>
        places;      // of each entry, from the top left of the tile [pixel]; empty: the tile is too small
    int height = 0;  // of the bar [pixel]
};
[[nodiscard]] HelpLayout helpLayout(glm::ivec2 tile /* [pixel] */, std::span<const HelpEntry> entries);

/// Bar over a tile's picture that names what buttons and keys do. It hides the picture below it, and changes no depth.
/// The GL context must be current. Used by one thread.
class HelpOverlay {
public:
    /// Throws std::runtime_error if the shader does not compile.
    explicit HelpOverlay(glm::ivec2 tile /* [pixel] */);

    /// Draws the bar into each target. The targets have the size of the tile.
    void draw(std::span<const EyeTarget> targets);
    /// Returns the pixels of a target that the bar covers; empty if the tile is too small.
    [[nodiscard]] const PixelRect& pixels() const { return pixels_; }

private:
    glm::ivec2 tile_;
    HelpLayout layout_;
    PixelRect pixels_;
    FlatPainter painter_;
};

}  // namespace render_node
