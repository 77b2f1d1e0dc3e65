// SPDX-License-Identifier: Apache-2.0
#include "render_node/overlay/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render_node/overlay/dot_font.hpp"

namespace render_node {
namespace {

// Sizes of a panel with graphs [dot].
constexpr int kPadding = 5, kLinePitch = 10, kLines = static_cast<int>(TileStatistics::kLongLines);
constexpr int kGraphLeft = kPadding + 7 * kGlyphPitch + 3;  // right of a value such as "31.2 MS"
constexpr int kGraphWidth = static_cast<int>(History::kLength), kGraphHeight = 24, kGraphPitch = 31;
constexpr int kGraphs = 4;
constexpr int kWidth = kGraphLeft + kGraphWidth + 3 + 4 * kGlyphPitch + kPadding;  // an axis ends at "0.05" or "2000"
constexpr int kTextHeight = kLines * kLinePitch;
constexpr int kHeight = kPadding + kTextHeight + kGraphs * kGraphPitch + 1;
static_assert(kWidth - 2 * kPadding >= static_cast<int>(TileStatistics::kLetters) * kGlyphPitch);

constexpr glm::vec3 kBack{0.07F, 0.08F, 0.10F}, kGraphBack{0.14F, 0.16F, 0.19F}, kGrid{0.32F, 0.35F, 0.40F};
constexpr glm::vec3 kText{0.92F, 0.93F, 0.95F}, kDim{0.62F, 0.65F, 0.70F};
constexpr glm::vec3 kGood{0.55F, 0.85F, 0.55F}, kSlow{1.0F, 0.75F, 0.25F}, kBad{1.0F, 0.40F, 0.35F};
constexpr glm::vec3 kFrameBar{0.55F, 0.72F, 0.95F}, kDrawBar{0.95F, 0.70F, 0.30F}, kWaitBar{0.40F, 0.78F, 0.70F},
    kSkewBar{0.80F, 0.60F, 0.90F};

glm::vec3 colourOf(TileStatistics::Line::Kind kind) {
    using Kind = TileStatistics::Line::Kind;
    return kind == Kind::good ? kGood : kind == Kind::slow ? kSlow : kind == Kind::bad ? kBad : kText;
}

/// Returns a layout with words only, which take at most three fifths of the tile's height.
OverlayLayout wordsAlone(glm::ivec2 tile) {
    constexpr int kMargin = 1, kInside = 2, kPitch = kGlyphHeight + 2;
    OverlayLayout layout;
    layout.letters = std::min(20, (tile.x - 2 * (kMargin + kInside) + 1) / kGlyphPitch);
    layout.lines = std::min(4, (3 * tile.y / 5 - 2 * kInside) / kPitch);
    if (layout.letters < 4 || layout.lines < 1) {
        return {};
    }
    layout.at = {kMargin, kMargin};
    layout.size = {layout.letters * kGlyphPitch - 1 + 2 * kInside, layout.lines * kPitch - 2 + 2 * kInside};
    return layout;
}

}  // namespace

struct StatisticsOverlay::Graph {
    const char* name;
    const History& history;
    double end;  // end of the axis [ms]
    glm::vec3 colour;
    double mark;  // height of a horizontal line [ms]; 0: no line
};

PixelRect OverlayLayout::pixels(glm::ivec2 tile) const {
    return {at.x, tile.y - at.y - size.y, at.x + size.x, tile.y - at.y};
}

OverlayLayout overlayLayout(glm::ivec2 tile) {
    if (5 * kWidth > 3 * tile.x || 5 * kHeight > 3 * tile.y) {
        return wordsAlone(tile);
    }
    OverlayLayout layout;
    layout.dot = std::max(1, std::min(2 * tile.x / (5 * kWidth), tile.y / (2 * kHeight)));
    layout.graphs = true;
    layout.letters = static_cast<int>(TileStatistics::kLetters);
    layout.lines = kLines;
    layout.at = glm::ivec2(4 * layout.dot);
    layout.size = glm::ivec2(kWidth, kHeight) * layout.dot;
    return layout;
}

double axisEnd(double value) {
    const double power = std::pow(10, std::floor(std::log10(value)));
    const double share = value / power * (1 - 1e-9);
    return power * (share <= 1 ? 1 : share <= 2 ? 2 : share <= 5 ? 5 : 10);
}

StatisticsOverlay::StatisticsOverlay(const walls::Wall& wall, const walls::Tile& tile, std::string host)
    : layout_(overlayLayout(tile.pixels)),
      pixels_(layout_.pixels(tile.pixels)),
      periodMs_(1000 / wall.refreshHz),
      statistics_(wall, tile, std::move(host)) {}

void StatisticsOverlay::addGraph(const Graph& graph, glm::ivec2 topLeft) {
    const int dot = layout_.dot;
    const glm::ivec2 size = glm::ivec2(kGraphWidth, kGraphHeight) * dot;
    const auto heightOf = [&](double ms) {
        return static_cast<int>(std::lround(std::min(ms / graph.end, 1.0) * size.y));
    };
    painter_.addText(graph.name, topLeft + glm::ivec2(kPadding, 2) * dot, dot, kDim);
    painter_.addText(milliseconds(graph.history.latest()) + " MS", topLeft + glm::ivec2(kPadding, 14) * dot, dot,
                     kText);
    const glm::ivec2 at = topLeft + glm::ivec2(kGraphLeft * dot, 0);
    painter_.addBox(at, size, kGraphBack);
    painter_.addBox(at + glm::ivec2(0, size.y / 2), {size.x, 1}, kGrid);
    // The newest value is at the right.
    int left = at.x + size.x - static_cast<int>(graph.history.values().size()) * dot;
    for (const double value : graph.history.values()) {
        const int height = heightOf(value);
        painter_.addBox({left, at.y + size.y - height}, {dot, height}, graph.colour);
        left += dot;
    }
    if (graph.mark > 0 && graph.mark < graph.end) {
        painter_.addBox({at.x, at.y + size.y - heightOf(graph.mark)}, {size.x, 1}, kText);
    }
    painter_.addBox(at + glm::ivec2(0, size.y - 1), {size.x, 1}, kDim);
    const glm::ivec2 axis = at + glm::ivec2(size.x + 3 * dot, 0);
    painter_.addText(fmt::format("{:g}", graph.end), axis, dot, kDim);
    painter_.addText("0", axis + glm::ivec2(0, (kGraphHeight - kGlyphHeight) * dot), dot, kDim);
}

void StatisticsOverlay::addPanel() {
    const int dot = layout_.dot;
    painter_.addBox(layout_.at, layout_.size, kBack);
    const int padding = layout_.graphs ? kPadding : 2;
    const int pitch = layout_.graphs ? kLinePitch : kGlyphHeight + 2;
    glm::ivec2 lineAt = layout_.at + glm::ivec2(padding) * dot;
    for (const auto& line :
         statistics_.lines(static_cast<std::size_t>(layout_.letters), static_cast<std::size_t>(layout_.lines))) {
        painter_.addText(line.text, lineAt, dot, colourOf(line.kind));
        lineAt.y += pitch * dot;
    }
    if (layout_.graphs) {
        // Frame, draw and wait share one axis, so that their lengths can be compared.
        const double end = axisEnd(std::max(
            {1.0, statistics_.frameMs().largest(), statistics_.drawMs().largest(), statistics_.waitMs().largest()}));
        const double skewEnd = axisEnd(std::max(0.1, statistics_.skewMs().largest()));
        const std::array<Graph, kGraphs> graphs{{{"FRAME", statistics_.frameMs(), end, kFrameBar, periodMs_},
                                                 {"DRAW", statistics_.drawMs(), end, kDrawBar, 0},
                                                 {"WAIT", statistics_.waitMs(), end, kWaitBar, 0},
                                                 {"SKEW", statistics_.skewMs(), skewEnd, kSkewBar, 0}}};
        glm::ivec2 at = layout_.at + glm::ivec2(0, kPadding + kTextHeight + 2) * dot;
        for (const Graph& graph : graphs) {
            addGraph(graph, at);
            at.y += kGraphPitch * dot;
        }
    }
    if (statistics_.drags()) {  // the frame can be seen from a distance
        painter_.addFrame(layout_.at, layout_.size, dot, kSlow);
    }
}

void StatisticsOverlay::draw(std::span<const EyeTarget> targets) {
    if (pixels_.empty() || targets.empty()) {
        return;
    }
    const auto& [x0, y0, x1, y1] = pixels_;
    addPanel();
    glEnable(GL_SCISSOR_TEST);
    glScissor(x0, y0, x1 - x0, y1 - y0);
    painter_.paint(targets.front());
    glDisable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, targets.front().framebuffer());
    for (const EyeTarget& target : targets.subspan(1)) {
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer());
        glBlitFramebuffer(x0, y0, x1, y1, x0, y0, x1, y1, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    }
}

}  // namespace render_node
