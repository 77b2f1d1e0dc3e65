// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>

#include "render_node/gl/eye_target.hpp"
#include "render_node/overlay/flat_painter.hpp"
#include "render_node/overlay/statistics_text.hpp"
#include "render_node/surface/pixel_rect.hpp"

namespace render_node {

/// Where the statistics lie on a tile, and what of them has room there.
struct OverlayLayout {
    glm::ivec2 at{0}, size{0};  // of the panel, from the top left [pixel]; no size: nothing has room
    int dot = 1;                // of letters [pixel]
    bool graphs = false;
    int letters = 0, lines = 0;

    [[nodiscard]] PixelRect pixels(glm::ivec2 tile) const;
};
/// In the upper left corner: words and graphs on a tile of 340 by 290 pixels or more, on smaller ones fewer words.
[[nodiscard]] OverlayLayout overlayLayout(glm::ivec2 tile /* [pixel] */);

/// A panel over a tile's picture that shows how the wall keeps up (docs/operator.md): words, and graphs of the last
/// frames.
///
/// It hides all that is beneath it and touches no other pixel, nor depth; it lies in the plane of the screen, equal
/// for both eyes. Made when it is first shown, let go when it is hidden. Needs its context current; one thread.
class StatisticsOverlay {
public:
    /// Throws std::runtime_error when the shader does not compile.
    StatisticsOverlay(const walls::Wall& wall, const walls::Tile& tile, std::string host);

    /// Of the frame before `frame`.
    void add(const TileFigures& figures, std::uint64_t frame) { statistics_.add(figures, frame); }
    /// Draws into each of the targets, which are of the tile's size.
    void draw(std::span<const EyeTarget> targets);
    /// What it covers of a target.
    [[nodiscard]] const PixelRect& pixels() const { return pixels_; }

private:
    struct Graph;
    void addPanel();
    void addGraph(const Graph& graph, glm::ivec2 topLeft);

    OverlayLayout layout_;
    PixelRect pixels_;
    double periodMs_;  // of the wall's refresh
    TileStatistics statistics_;
    FlatPainter painter_;
};

/// The least of 1, 2 and 5 times a power of ten that is not below `value`: the end of a graph's axis.
[[nodiscard]] double axisEnd(double value);

}  // namespace render_node
