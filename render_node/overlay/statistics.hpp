// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>

#include "render_node/gl/eye_target.hpp"
#include "render_node/gl/pixel_rect.hpp"
#include "render_node/overlay/flat_painter.hpp"
#include "render_node/overlay/letters.hpp"
#include "render_node/overlay/statistics_text.hpp"
#include "render_node/overlay/text_panel.hpp"

namespace render_node {

/// Place of the statistics on a tile, and the parts of them that fit there.
struct OverlayLayout {
    glm::ivec2 at{0}, size{0};   // of the panel, from the top left [pixel]; size 0: the tile is too small for a panel
    const Face* face = nullptr;  // of the words; null: letters of dots, and no graphs
    int letters = 0, lines = 0;

    [[nodiscard]] PixelRect pixels(glm::ivec2 tile) const;
};
/// Returns the layout for a tile. The panel is in the upper left corner. Tiles of 349 × 332 pixels or more have words
/// and graphs in the font of the help. Smaller tiles have fewer words, in letters of 5 × 7 dots, because the smallest
/// size of the font is larger, and no graphs.
[[nodiscard]] OverlayLayout overlayLayout(glm::ivec2 tile /* [pixel] */);

/// Panel over a tile's picture that shows how well the wall keeps its pace (docs/operator.md). It has words, and graphs
/// of the last frames.
///
/// The panel hides the picture below it. It changes no other pixel and no depth. It lies in the plane of the screen, so
/// that both eyes see the same. The object is made when the panel is first shown, and destroyed when the panel is
/// hidden. The GL context must be current. Used by one thread.
class StatisticsOverlay {
public:
    /// Throws std::runtime_error if the shader does not compile.
    StatisticsOverlay(const walls::Wall& wall, const walls::Tile& tile, std::string host);

    /// Adds the figures of the frame before `frame`.
    void add(const TileFigures& figures, std::uint64_t frame) { statistics_.add(figures, frame); }
    /// Draws the panel into each target. The targets have the size of the tile.
    void draw(std::span<const EyeTarget> targets);
    /// Returns the pixels of a target that the panel covers.
    [[nodiscard]] const PixelRect& pixels() const { return pixels_; }

private:
    struct Graph;
    [[nodiscard]] Sheet panel() const;
    void addGraph(Sheet& sheet, const Graph& graph, glm::ivec2 topLeft) const;
    void paintDots(const EyeTarget& target);

    OverlayLayout layout_;
    PixelRect pixels_;
    double periodMs_;  // period of the wall's refresh rate
    TileStatistics statistics_;
    std::optional<PanelPainter> panelPainter_;  // of a layout with a face
    std::optional<FlatPainter> dotPainter_;     // of a layout without one
};

/// Returns the end of a graph's axis: the smallest of 1, 2 and 5 times a power of ten that is at least `value`.
[[nodiscard]] double axisEnd(double value);

}  // namespace render_node
