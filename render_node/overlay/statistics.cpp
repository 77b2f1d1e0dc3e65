// SPDX-License-Identifier: Apache-2.0
#include "render_node/overlay/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render_node/overlay/dot_font.hpp"

namespace render_node {
namespace {

constexpr int kLines = static_cast<int>(TileStatistics::kLongLines), kGraphs = 4;
constexpr int kDotsInside = 2, kDotsPitch = kGlyphHeight + 2;  // around and between lines of dots [pixel]
constexpr int kBars = static_cast<int>(History::kLength);

constexpr glm::vec3 kBack{0.07F, 0.08F, 0.10F}, kGraphBack{0.14F, 0.16F, 0.19F}, kGrid{0.32F, 0.35F, 0.40F};
constexpr glm::vec3 kText{0.92F, 0.93F, 0.95F}, kDim{0.62F, 0.65F, 0.70F};
constexpr glm::vec3 kGood{0.55F, 0.85F, 0.55F}, kSlow{1.0F, 0.75F, 0.25F}, kBad{1.0F, 0.40F, 0.35F};
constexpr glm::vec3 kFrameBar{0.55F, 0.72F, 0.95F}, kDrawBar{0.95F, 0.70F, 0.30F}, kWaitBar{0.40F, 0.78F, 0.70F},
    kSkewBar{0.80F, 0.60F, 0.90F};

glm::vec3 colourOf(TileStatistics::Line::Kind kind) {
    using Kind = TileStatistics::Line::Kind;
    return kind == Kind::good ? kGood : kind == Kind::slow ? kSlow : kind == Kind::bad ? kBad : kText;
}

glm::u8vec3 levelsOf(const glm::vec3& colour) { return glm::u8vec3(glm::round(colour * 255.0F)); }

/// Lengths of a panel with graphs in the letters of `face` [pixel].
struct PanelLengths {
    explicit PanelLengths(const Face& face)
        : padding(face.size / 2),
          gap(std::max(2, face.size / 4)),
          bar(std::max(1, face.size / 9)),
          graphLeft(padding + textWidth(face, "1000.0 MS") + gap),
          graphHeight(2 * face.lineHeight),
          graphPitch(graphHeight + padding) {
        const int graphs = graphLeft + kBars * bar + gap + textWidth(face, "2000") + padding;  // or an axis to "0.05"
        const int words = textWidth(face, "DIFFERED IN 1000 FRAMES, HEALED 10") + 2 * padding;
        size = {std::max(graphs, words), 2 * padding + kLines * face.lineHeight + kGraphs * graphPitch};
    }

    int padding, gap, bar;  // bar: of one frame
    int graphLeft, graphHeight, graphPitch;
    glm::ivec2 size{0};
};

/// Returns a text without the last letters that have no room.
std::string cutTo(const Face& face, std::string text, int width) {
    while (!text.empty() && textWidth(face, text) > width) {
        text.pop_back();
    }
    return text;
}

/// Returns a layout with words only, which take at most three fifths of the tile's height.
OverlayLayout wordsAlone(glm::ivec2 tile) {
    constexpr int kMargin = 1;
    OverlayLayout layout;
    layout.letters = std::min(20, (tile.x - 2 * (kMargin + kDotsInside) + 1) / kGlyphPitch);
    layout.lines = std::min(4, (3 * tile.y / 5 - 2 * kDotsInside) / kDotsPitch);
    if (layout.letters < 4 || layout.lines < 1) {
        return {};
    }
    layout.at = {kMargin, kMargin};
    layout.size = {layout.letters * kGlyphPitch - 1 + 2 * kDotsInside, layout.lines * kDotsPitch - 2 + 2 * kDotsInside};
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
    OverlayLayout layout;
    for (const Face& face : faces()) {
        const glm::ivec2 size = PanelLengths(face).size;
        const bool small = 5 * size.x <= 2 * tile.x && 2 * size.y <= tile.y;
        const bool onlyOne = layout.face == nullptr && 5 * size.x <= 3 * tile.x && 5 * size.y <= 3 * tile.y;
        if (small || onlyOne) {
            layout.face = &face;
            layout.size = size;
        }
    }
    if (layout.face == nullptr) {
        return wordsAlone(tile);
    }
    layout.letters = static_cast<int>(TileStatistics::kLetters);
    layout.lines = kLines;
    layout.at = glm::ivec2(layout.face->size / 2);
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
      statistics_(wall, tile, std::move(host)) {
    if (layout_.face != nullptr) {
        panelPainter_.emplace();
    } else {
        dotPainter_.emplace();
    }
}

void StatisticsOverlay::addGraph(Sheet& sheet, const Graph& graph, glm::ivec2 topLeft) const {
    const Face& face = *layout_.face;
    const PanelLengths lengths(face);
    const glm::ivec2 size(kBars * lengths.bar, lengths.graphHeight);
    const auto heightOf = [&](double ms) {
        return static_cast<int>(std::lround(std::min(ms / graph.end, 1.0) * size.y));
    };
    sheet.write(face, graph.name, topLeft + glm::ivec2(lengths.padding, 0), levelsOf(kDim));
    sheet.write(face, milliseconds(graph.history.latest()) + " MS",
                topLeft + glm::ivec2(lengths.padding, face.lineHeight), levelsOf(kText));
    const glm::ivec2 at = topLeft + glm::ivec2(lengths.graphLeft, 0);
    sheet.fill(at, size, levelsOf(kGraphBack));
    sheet.fill(at + glm::ivec2(0, size.y / 2), {size.x, 1}, levelsOf(kGrid));
    // The newest value is at the right.
    int left = at.x + size.x - static_cast<int>(graph.history.values().size()) * lengths.bar;
    for (const double value : graph.history.values()) {
        const int height = heightOf(value);
        sheet.fill({left, at.y + size.y - height}, {lengths.bar, height}, levelsOf(graph.colour));
        left += lengths.bar;
    }
    if (graph.mark > 0 && graph.mark < graph.end) {
        sheet.fill({at.x, at.y + size.y - heightOf(graph.mark)}, {size.x, 1}, levelsOf(kText));
    }
    sheet.fill(at + glm::ivec2(0, size.y - 1), {size.x, 1}, levelsOf(kDim));
    const glm::ivec2 axis = at + glm::ivec2(size.x + lengths.gap, 0);
    sheet.write(face, fmt::format("{:g}", graph.end), axis, levelsOf(kDim));
    sheet.write(face, "0", axis + glm::ivec2(0, size.y - face.lineHeight), levelsOf(kDim));
}

/// Returns the panel with words and graphs.
Sheet StatisticsOverlay::panel() const {
    const Face& face = *layout_.face;
    const PanelLengths lengths(face);
    Sheet sheet(layout_.size, levelsOf(kBack));
    glm::ivec2 at(lengths.padding);
    for (const auto& line :
         statistics_.lines(static_cast<std::size_t>(layout_.letters), static_cast<std::size_t>(layout_.lines))) {
        sheet.write(face, cutTo(face, line.text, layout_.size.x - 2 * lengths.padding), at,
                    levelsOf(colourOf(line.kind)));
        at.y += face.lineHeight;
    }
    // Frame, draw and wait share one axis, so that their lengths can be compared.
    const double end = axisEnd(std::max(
        {1.0, statistics_.frameMs().largest(), statistics_.drawMs().largest(), statistics_.waitMs().largest()}));
    const double skewEnd = axisEnd(std::max(0.1, statistics_.skewMs().largest()));
    const std::array<Graph, kGraphs> graphs{{{"FRAME", statistics_.frameMs(), end, kFrameBar, periodMs_},
                                             {"DRAW", statistics_.drawMs(), end, kDrawBar, 0},
                                             {"WAIT", statistics_.waitMs(), end, kWaitBar, 0},
                                             {"SKEW", statistics_.skewMs(), skewEnd, kSkewBar, 0}}};
    at = {0, lengths.padding + kLines * face.lineHeight + lengths.padding};
    for (const Graph& graph : graphs) {
        addGraph(sheet, graph, at);
        at.y += lengths.graphPitch;
    }
    if (statistics_.drags()) {  // the frame can be seen from a distance
        const glm::u8vec3 slow = levelsOf(kSlow);
        sheet.fill({0, 0}, {layout_.size.x, lengths.bar}, slow);
        sheet.fill({0, layout_.size.y - lengths.bar}, {layout_.size.x, lengths.bar}, slow);
        sheet.fill({0, 0}, {lengths.bar, layout_.size.y}, slow);
        sheet.fill({layout_.size.x - lengths.bar, 0}, {lengths.bar, layout_.size.y}, slow);
    }
    return sheet;
}

/// Draws the words of a small tile.
void StatisticsOverlay::paintDots(const EyeTarget& target) {
    const auto& [x0, y0, x1, y1] = pixels_;
    dotPainter_->addBox(layout_.at, layout_.size, kBack);
    glm::ivec2 lineAt = layout_.at + kDotsInside;
    for (const auto& line :
         statistics_.lines(static_cast<std::size_t>(layout_.letters), static_cast<std::size_t>(layout_.lines))) {
        dotPainter_->addText(line.text, lineAt, 1, colourOf(line.kind));
        lineAt.y += kDotsPitch;
    }
    if (statistics_.drags()) {
        dotPainter_->addFrame(layout_.at, layout_.size, 1, kSlow);
    }
    glEnable(GL_SCISSOR_TEST);
    glScissor(x0, y0, x1 - x0, y1 - y0);
    dotPainter_->paint(target);
    glDisable(GL_SCISSOR_TEST);
}

void StatisticsOverlay::draw(std::span<const EyeTarget> targets) {
    if (pixels_.empty() || targets.empty()) {
        return;
    }
    const auto& [x0, y0, x1, y1] = pixels_;
    if (panelPainter_) {
        panelPainter_->draw(TextPanel(panel(), layout_.at, targets.front().height()), targets.front());
    } else {
        paintDots(targets.front());
    }
    glBindFramebuffer(GL_READ_FRAMEBUFFER, targets.front().framebuffer());
    for (const EyeTarget& target : targets.subspan(1)) {
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer());
        glBlitFramebuffer(x0, y0, x1, y1, x0, y0, x1, y1, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    }
}

}  // namespace render_node
