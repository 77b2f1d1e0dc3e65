// SPDX-License-Identifier: Apache-2.0
#include "render_node/overlay/help.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "render_node/overlay/dot_font.hpp"

namespace render_node {
namespace {

int endOf(const HelpLayout& layout, std::size_t i) {
    const HelpEntry& entry = pointerHelp()[i];
    return layout.places[i].x + static_cast<int>(entry.key.size() + 1 + entry.effect.size()) * kGlyphPitch * layout.dot;
}

TEST(Help, IsABarAlongTheLowerEdgeInWhichNoEntriesOverlap) {
    for (const glm::ivec2 tile : {glm::ivec2(1280, 720), glm::ivec2(640, 480), glm::ivec2(3840, 2160)}) {
        const HelpLayout layout = helpLayout(tile, pointerHelp());
        ASSERT_EQ(layout.places.size(), pointerHelp().size()) << tile.x;
        EXPECT_LE(3 * layout.height, tile.y);
        for (std::size_t i = 0; i < layout.places.size(); ++i) {
            EXPECT_GE(layout.places[i].y, tile.y - layout.height);
            EXPECT_LE(layout.places[i].y + kGlyphHeight * layout.dot, tile.y);
            EXPECT_LE(endOf(layout, i), tile.x);
            if (i > 0 && layout.places[i].y == layout.places[i - 1].y) {
                EXPECT_GT(layout.places[i].x, endOf(layout, i - 1));
            }
        }
    }
}

TEST(Help, IsLeftOutWhereItWouldHideTheSand) {
    for (const glm::ivec2 tile : {glm::ivec2(96, 72), glm::ivec2(1280, 60)}) {
        const HelpLayout layout = helpLayout(tile, pointerHelp());
        EXPECT_EQ(layout.height, 0);
        EXPECT_TRUE(layout.places.empty());
    }
}

TEST(Help, UsesLettersThatTheFontHas) {
    const auto unknown = glyphOf('~');
    for (const HelpEntry& entry : pointerHelp()) {
        for (const std::string_view text : {entry.key, entry.effect}) {
            EXPECT_TRUE(std::ranges::none_of(text, [&](char letter) { return glyphOf(letter) == unknown; })) << text;
        }
    }
}

}  // namespace
}  // namespace render_node
