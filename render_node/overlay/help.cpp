// SPDX-License-Identifier: Apache-2.0
#include "render_node/overlay/help.hpp"

#include <algorithm>
#include <array>

#include "render_node/overlay/dot_font.hpp"

namespace render_node {
namespace {

constexpr std::array<HelpEntry, 13> kPointer{{{"LEFT BUTTON", "DIG"},
                                              {"WHEEL", "ZOOM"},
                                              {"SHIFT WHEEL", "DEPTH"},
                                              {"RIGHT BUTTON", "TURN THE SAND"},
                                              {"MIDDLE BUTTON", "MOVE IT"},
                                              {"HOME", "ALL IN VIEW"},
                                              {"1 - 6", "TOOL"},
                                              {"+ -", "SIZE"},
                                              {"W D", "WETTER, DRIER"},
                                              {"U", "UNDO"},
                                              {"SHIFT R", "RESET"},
                                              {"H", "HIDE THIS"},
                                              {"ESC", "QUIT"}}};

// Sizes [dot].
constexpr int kHelpPadding = 6, kHelpPitch = kGlyphHeight + 5, kHelpGap = 4 * kGlyphPitch;
constexpr int kHelpUsualWidth = 640;  // of a tile whose letters have dots of one pixel

constexpr glm::vec3 kHelpBack{0.07F, 0.08F, 0.10F}, kHelpEdge{0.62F, 0.50F, 0.33F}, kHelpKey{0.95F, 0.80F, 0.52F},
    kHelpText{0.88F, 0.89F, 0.91F};

int lettersInEntry(const HelpEntry& entry) { return static_cast<int>(entry.key.size() + 1 + entry.effect.size()); }

}  // namespace

std::span<const HelpEntry> pointerHelp() { return kPointer; }

HelpLayout helpLayout(glm::ivec2 tile, std::span<const HelpEntry> entries) {
    HelpLayout layout;
    layout.dot = std::max(1, tile.x / kHelpUsualWidth);
    const int width = tile.x / layout.dot - 2 * kHelpPadding;
    glm::ivec2 at(0);
    std::vector<glm::ivec2> places;  // [dot], from the top left of the text
    for (const HelpEntry& entry : entries) {
        const int length = lettersInEntry(entry) * kGlyphPitch - 1;
        if (at.x > 0 && at.x + length > width) {
            at = {0, at.y + kHelpPitch};
        }
        if (length > width) {
            return layout;
        }
        places.push_back(at);
        at.x += length + kHelpGap;
    }
    layout.height = (at.y + kGlyphHeight + 2 * kHelpPadding) * layout.dot;
    if (3 * layout.height > tile.y) {  // the bar would hide too much of the sand
        layout.height = 0;
        return layout;
    }
    for (const glm::ivec2 place : places) {
        layout.places.push_back((place + kHelpPadding) * layout.dot + glm::ivec2(0, tile.y - layout.height));
    }
    return layout;
}

HelpOverlay::HelpOverlay(glm::ivec2 tile)
    : tile_(tile), layout_(helpLayout(tile, pointerHelp())), pixels_{0, 0, tile.x, layout_.height} {}

void HelpOverlay::draw(std::span<const EyeTarget> targets) {
    if (pixels_.empty()) {
        return;
    }
    for (const EyeTarget& target : targets) {
        const int top = tile_.y - layout_.height;
        painter_.addBox({0, top}, {tile_.x, layout_.height}, kHelpBack);
        painter_.addBox({0, top}, {tile_.x, layout_.dot}, kHelpEdge);
        for (std::size_t i = 0; i < layout_.places.size(); ++i) {
            const HelpEntry& entry = pointerHelp()[i];
            const glm::ivec2 place = layout_.places[i];
            const int indent = static_cast<int>(entry.key.size() + 1) * kGlyphPitch * layout_.dot;
            painter_.addText(entry.key, place, layout_.dot, kHelpKey);
            painter_.addText(entry.effect, place + glm::ivec2(indent, 0), layout_.dot, kHelpText);
        }
        painter_.paint(target);
    }
}

}  // namespace render_node
