// SPDX-License-Identifier: Apache-2.0
#include "render_node/overlay/test_pattern.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace render_node {
namespace {

using lockstep::Pattern;
using walls::Eye;

constexpr glm::vec3 kBlack{0}, kWhite{1}, kRed{1, 0, 0}, kCyan{0, 1, 1};

/// Returns the size of the area for the grid pattern: the whole grid of tiles, or a single explicit screen.
glm::dvec2 extentOf(const walls::Wall& wall, const walls::Tile& tile) {
    if (tile.row == 0 || !wall.grid) {
        return {tile.screen.width(), tile.screen.height()};
    }
    const walls::Grid& grid = *wall.grid;
    const glm::dvec2 counts(grid.columns, grid.rows);
    return counts * (grid.tileSize + grid.bezel) - grid.bezel;
}

glm::dvec2 cornerOf(const walls::Wall& wall, const walls::Tile& tile) {
    const glm::dvec2 middle = extentOf(wall, tile) / 2.0;
    if (tile.row == 0 || !wall.grid) {
        return -middle;
    }
    const glm::dvec3 along = tile.screen.lowerLeft - wall.grid->lowerLeft;
    return glm::dvec2(glm::dot(along, wall.grid->right), glm::dot(along, wall.grid->up)) - middle;
}

std::string eyeText(Eye eye) { return eye == Eye::left ? "LEFT EYE" : eye == Eye::right ? "RIGHT EYE" : "MONO"; }

/// Returns the eye's colour. Through red-cyan glasses each eye sees only its own colour.
glm::vec3 colourOf(Eye eye) { return eye == Eye::left ? kRed : eye == Eye::right ? kCyan : kWhite; }

/// Returns the left border of the half of a tile that is reserved for this eye. Then texts of both eyes can be read in
/// one picture.
int leftOfOwn(Eye eye, int width) { return eye == Eye::right ? width / 2 : eye == Eye::left ? 0 : width / 4; }

}  // namespace

double gridSpacing(glm::dvec2 size) {
    const double most = std::min(size.x, size.y) / 8;
    const double power = std::pow(10, std::floor(std::log10(most)));
    const double share = most / power * (1 + 1e-9);
    return power * (share >= 5 ? 5 : share >= 2 ? 2 : 1);
}

TestPatternView::TestPatternView(const walls::Wall& wall, const walls::Tile& tile, std::string host)
    : tile_(tile),
      host_(std::move(host)),
      corner_(cornerOf(wall, tile)),
      spacing_(gridSpacing(extentOf(wall, tile))),
      gridProgram_(shaderSource("whole.vert.glsl"), ShaderSource{}, shaderSource("grid.frag.glsl")) {}

void TestPatternView::draw(Pattern pattern, Eye eye, std::uint64_t frame, const EyeTarget& target) {
    const glm::ivec2 size(target.width(), target.height());
    switch (pattern) {
        case Pattern::none:
            throw std::invalid_argument("no test pattern to draw");
        case Pattern::grid:
            drawGrid(target);
            break;
        case Pattern::tiles:
            addTile(eye, size);
            break;
        case Pattern::eyes:
            addEyes(eye, size);
            break;
        case Pattern::flash:
            addFlash(frame, size);
            break;
        case Pattern::ramp:
            addRamp(size);
            break;
    }
    painter_.paint(target);
}

void TestPatternView::addCentred(std::string_view text, glm::ivec2 topLeft, glm::ivec2 box, glm::vec3 colour) {
    const int dot = dotToFit(text, box);
    painter_.addText(text, topLeft + (box - textSize(text) * dot) / 2, dot, colour);
}

void TestPatternView::drawGrid(const EyeTarget& target) {
    const glm::ivec2 size(target.width(), target.height());
    target.bind();
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    gridProgram_.use();
    gridProgram_.set("uCorner", glm::vec2(corner_));
    gridProgram_.set("uPixel", glm::vec2(glm::dvec2(tile_.screen.width(), tile_.screen.height()) / glm::dvec2(size)));
    gridProgram_.set("uSpacing", static_cast<float>(spacing_));
    glBindVertexArray(noVertices_.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    gridProgram_.drawn();

    const std::string label = fmt::format("{}  GRID {:g} M", tile_.name, spacing_);
    const int dot = dotToFit(label, {size.x / 3, std::max(8, size.y / 40)});
    const glm::ivec2 box = textSize(label) * dot + 6 * dot;
    const glm::ivec2 at(size.x / 40 + 2, size.y - box.y - size.y / 40 - 2);
    painter_.addBox(at, box, kBlack);
    painter_.addText(label, at + 3 * dot, dot, kWhite);
    painter_.addFrame({0, 0}, size, 1, kWhite);
}

void TestPatternView::addTile(Eye eye, glm::ivec2 size) {
    const bool explicitScreen = tile_.row == 0;
    const bool even = (explicitScreen ? tile_.rank : tile_.row + tile_.column) % 2 == 0;
    const std::array lines{fmt::format("RANK {}", tile_.rank), fmt::format("HOST {}", host_),
                           explicitScreen ? fmt::format("SCREEN {}", tile_.name)
                                          : fmt::format("ROW {} COLUMN {}", tile_.row, tile_.column),
                           fmt::format("{} X {} PIXELS", tile_.pixels.x, tile_.pixels.y)};
    painter_.addBox({0, 0}, size, even ? glm::vec3(0.10F, 0.16F, 0.26F) : glm::vec3(0.24F, 0.18F, 0.10F));
    painter_.addFrame({0, 0}, size, std::max(1, size.y / 100), kWhite);
    const int lineHeight = size.y / 7;
    const int margin = size.x / 16;
    const glm::ivec2 room(size.x - 2 * margin, lineHeight * 2 / 3);
    int dot = dotToFit(lines[0], room);
    for (const std::string& line : lines) {
        dot = std::min(dot, dotToFit(line, room));
    }
    int top = size.y / 14;
    for (const std::string& line : lines) {
        painter_.addText(line, {(size.x - textSize(line).x * dot) / 2, top}, dot, kWhite);
        top += lineHeight;
    }
    // Each eye has its own half, so that both texts can be read if both eyes are mixed into one picture.
    addCentred(eyeText(eye), {leftOfOwn(eye, size.x) + margin / 2, top + lineHeight / 2},
               {size.x / 2 - margin, lineHeight}, colourOf(eye));
}

void TestPatternView::addEyes(Eye eye, glm::ivec2 size) {
    const glm::vec3 colour = colourOf(eye);
    const std::string letter = eye == Eye::left ? "L" : eye == Eye::right ? "R" : "M";
    const int quarter = size.x / 4;
    const int half = leftOfOwn(eye, size.x);
    painter_.addBox({0, 0}, size, kBlack);
    // The bars are at the outer side of the eye's half, its letter at the inner side.
    constexpr int kBars = 9;
    for (int bar = 0; bar < kBars && eye != Eye::middle; bar += 2) {
        const int top = size.y * bar / kBars;
        painter_.addBox({eye == Eye::left ? 0 : size.x - quarter / 2, top},
                        {quarter / 2, size.y * (bar + 1) / kBars - top}, colour);
    }
    const int letterLeft = eye == Eye::right ? half : half + (eye == Eye::left ? quarter / 2 : 0);
    const int letterWidth = eye == Eye::middle ? 2 * quarter : 3 * quarter / 2;
    addCentred(letter, {letterLeft, size.y / 8}, {letterWidth, size.y / 2}, colour);
    addCentred(eyeText(eye), {letterLeft + quarter / 8, size.y * 3 / 4}, {letterWidth - quarter / 4, size.y / 8},
               colour);
    painter_.addFrame({0, 0}, size, std::max(1, size.y / 100), kWhite);
}

void TestPatternView::addFlash(std::uint64_t frame, glm::ivec2 size) {
    constexpr std::array<glm::vec3, 4> kColours{{{0.8F, 0, 0}, {0, 0.65F, 0}, {0, 0.15F, 0.9F}, {0.8F, 0.8F, 0.8F}}};
    painter_.addBox({0, 0}, size, kColours.at(frame % 4));
    const glm::ivec2 box(size.x / 2, size.y / 4);
    const glm::ivec2 at = (size - box) / 2;
    painter_.addBox(at, box, kBlack);
    addCentred(std::to_string(frame), at + box / 8, box - box / 4, kWhite);
}

void TestPatternView::addRamp(glm::ivec2 size) {
    constexpr int kSteps = 17;  // 0, 16, 32 … 240, 255
    const auto grey = [](int level) { return glm::vec3(static_cast<float>(level) / 255.0F); };
    const int stepsHigh = size.y * 2 / 3;
    // A number needs the width of three letters. If the steps are narrower, only every second or fourth step has a
    // number.
    const int needed = textSize("255").x + 2;
    const int stride = size.x / kSteps >= needed ? 1 : size.x / kSteps * 2 >= needed ? 2 : 4;
    for (int step = 0; step < kSteps; ++step) {
        const int left = size.x * step / kSteps;
        const int wide = size.x * (step + 1) / kSteps - left;
        painter_.addBox({left, 0}, {wide, stepsHigh}, grey(std::min(255, 16 * step)));
    }
    const int dot = dotToFit("255", {size.x / kSteps - 2, stepsHigh / 8});
    for (int step = 0; step < kSteps; step += stride) {
        const int level = std::min(255, 16 * step);
        const std::string number = std::to_string(level);
        const int middle = size.x * (2 * step + 1) / (2 * kSteps);
        const int wide = textSize(number).x * dot;
        painter_.addText(number, {std::min(middle - wide / 2, size.x - wide), stepsHigh / 2}, dot,
                         level < 128 ? kWhite : kBlack);
    }
    for (int level = 0; level < 256; ++level) {
        const int left = size.x * level / 256;
        painter_.addBox({left, stepsHigh}, {size.x * (level + 1) / 256 - left, size.y - stepsHigh}, grey(level));
    }
}

}  // namespace render_node
