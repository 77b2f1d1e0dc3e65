// SPDX-License-Identifier: Apache-2.0
#include "render_node/overlay/help.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "lockstep/key_list.hpp"
#include "walls/wall_file.hpp"

namespace render_node {
namespace {

/// Returns how many pixels of a sheet have not the colour of its corner below the edge.
int inkOf(const Sheet& sheet) {
    int ink = 0;
    const std::size_t back = sheet.rgb().size() - 3;
    for (std::size_t i = 0; i + 2 < sheet.rgb().size(); i += 3) {
        ink += std::equal(sheet.rgb().begin() + static_cast<std::ptrdiff_t>(i),
                          sheet.rgb().begin() + static_cast<std::ptrdiff_t>(i) + 3,
                          sheet.rgb().begin() + static_cast<std::ptrdiff_t>(back))
                   ? 0
                   : 1;
    }
    return ink;
}

walls::Wall wallNamed(const std::string& name) {
    return walls::loadWall(std::string(SANDWALL_SOURCE_DIR "/walls/configs/") + name + ".toml");
}

TEST(Letters, AreFoundForEveryTextOfTheHelpAndTheHint) {
    const Face& face = faceFor(16);
    std::vector<std::string> texts{lockstep::hint(), "heading 35°"};
    for (const HelpEntry& entry : helpEntries()) {
        texts.insert(texts.end(), {entry.keys, entry.effect});
    }
    const int unknown = textWidth(face, "\xc2\xbf");  // an inverted question mark, which is not baked
    EXPECT_EQ(unknown, textWidth(face, "?"));
    for (const std::string& text : texts) {
        for (std::size_t i = 0; i < text.size(); ++i) {
            const auto byte = static_cast<unsigned char>(text[i]);
            const std::size_t length = byte < 0x80 ? 1 : byte < 0xe0 ? 2 : 3;
            const std::string character = text.substr(i, length);
            i += length - 1;
            const Sheet blank({40, 40}, {0, 0, 0});
            Sheet drawn({40, 40}, {0, 0, 0}), question({40, 40}, {0, 0, 0});
            drawn.write(face, character, {0, 0}, {255, 255, 255});
            question.write(face, "?", {0, 0}, {255, 255, 255});
            EXPECT_EQ(std::ranges::equal(drawn.rgb(), question.rgb()), character == "?") << text;
            EXPECT_EQ(std::ranges::equal(drawn.rgb(), blank.rgb()), character == " ") << text;
        }
    }
}

TEST(Letters, HaveTheirSizeAndStayInTheirLine) {
    int before = 0;
    for (const Face& face : faces()) {
        EXPECT_GT(face.size, before);
        before = face.size;
        EXPECT_NEAR(textWidth(face, "mm"), 2 * 0.974 * face.size, 2) << "an m of DejaVu Sans is 0.974 em wide";
        Sheet above({200, face.lineHeight + 40}, {0, 0, 0});
        above.write(face, "Qgj|()", {5, 20}, {255, 255, 255});
        for (int y = 0; y < above.size().y; ++y) {
            for (int x = 0; x < 200; ++x) {
                const bool line = y >= 20 && y < 20 + face.lineHeight;
                EXPECT_TRUE(line || above.rgb()[3 * static_cast<std::size_t>(y * 200 + x)] == 0) << face.size;
            }
        }
    }
    EXPECT_EQ(faceFor(1).size, faces().front().size);
    EXPECT_EQ(faceFor(1000).size, faces().back().size);
    EXPECT_LE(faceFor(25).size, 25);
}

TEST(Letters, OfBrokenTextAreQuestionMarks) {
    const Face& face = faceFor(16);
    for (const char* text : {"\xff", "\xc2", "\xe2\x80", "\x80"}) {
        const int bytes = static_cast<int>(std::string_view(text).size());
        EXPECT_EQ(textWidth(face, text), bytes * textWidth(face, "?")) << "and nothing is read behind the end";
    }
}

TEST(Help, HasEveryKeyAndNoOther) {
    const std::vector<HelpEntry> entries = helpEntries();
    ASSERT_EQ(entries.size(), lockstep::mouseList().size() + lockstep::keyList().size());
    for (std::size_t i = 0; i < lockstep::keyList().size(); ++i) {
        EXPECT_EQ(entries[lockstep::mouseList().size() + i].keys, keyNames(lockstep::keyList()[i]));
    }
}

/// Returns the pixels of all entries' texts in a face, each text written alone.
int inkOfEntries(const Face& face) {
    int ink = 0;
    for (const HelpEntry& entry : helpEntries()) {
        for (const std::string& text : {entry.keys, entry.effect}) {
            Sheet sheet({textWidth(face, text) + face.size, 2 * face.lineHeight}, {0, 0, 0});
            sheet.write(face, text, {face.size / 2, face.lineHeight / 2}, {255, 255, 255});
            ink += inkOf(sheet);
        }
    }
    return ink;
}
/// Returns the size of the letters in which sheets together show all entries, whole and apart; 0 if there is none.
int sizeOfWholeTexts(const std::vector<Sheet>& sheets) {
    for (const Face& face : faces()) {
        int ink = 0;
        for (const Sheet& sheet : sheets) {
            ink += sheet.size().y == 0 ? 0 : inkOf(sheet) - sheet.size().x * std::max(1, face.size / 12);  // the edge
        }
        if (ink == inkOfEntries(face)) {
            return face.size;
        }
    }
    return 0;
}

TEST(Help, ShowsAllEntriesInAtMostSevenTenthsOfATile) {
    for (const glm::ivec2 tile : {glm::ivec2(640, 360), glm::ivec2(640, 480), glm::ivec2(1280, 720),
                                  glm::ivec2(1920, 1080), glm::ivec2(3840, 2160)}) {
        const Sheet sheet = helpSheet({0, 1, tile}, tile);
        EXPECT_EQ(sheet.size().x, tile.x);
        EXPECT_LE(10 * sheet.size().y, 7 * tile.y);
        EXPECT_GE(sizeOfWholeTexts({sheet}), std::max(13, tile.y / 60)) << tile.x;
    }
}

// 400 x 300 pixels are too few for letters that can be read, but four such tiles side by side have room.
TEST(Help, IsDividedAmongSmallTilesOfARow) {
    for (const glm::ivec2 tile : {glm::ivec2(478, 358), glm::ivec2(400, 300), glm::ivec2(318, 238)}) {
        std::vector<Sheet> sheets;
        std::vector<int> ink;
        for (int i = 0; i < 4; ++i) {
            sheets.push_back(helpSheet({i, 4, tile}, tile));
            EXPECT_EQ(sheets.back().size(), sheets.front().size());
            EXPECT_LE(10 * sheets.back().size().y, 7 * tile.y);
            ink.push_back(inkOf(sheets.back()));
        }
        EXPECT_EQ(sizeOfWholeTexts(sheets), 13) << tile.x;
        EXPECT_EQ(std::ranges::count(ink, ink[0]), 1) << "each shows other entries";
    }
}

TEST(Help, HasSmallLettersOnTheSmallTilesOfARow) {
    const glm::ivec2 tile(254, 142);
    std::vector<Sheet> sheets;
    sheets.reserve(4);
    for (int i = 0; i < 4; ++i) {
        sheets.push_back(helpSheet({i, 4, tile}, tile));
    }
    EXPECT_EQ(sizeOfWholeTexts(sheets), 10);
    EXPECT_EQ(helpSheet({29, 30, {300, 40}}, {300, 40}).size().x, 300) << "no entry is left for the last of many tiles";
}

TEST(Help, TakesTheWholeOfASmallTile) {
    const glm::ivec2 tile(300, 400);
    const Sheet sheet = helpSheet({0, 1, tile}, tile);
    EXPECT_LE(sheet.size().y, tile.y);
    EXPECT_NE(sizeOfWholeTexts({sheet}), 0);
}

TEST(Help, ShowsThePartThatFitsOnTheSmallestTiles) {
    for (const glm::ivec2 tile : {glm::ivec2(1, 1), glm::ivec2(96, 72), glm::ivec2(300, 30), glm::ivec2(50, 500)}) {
        for (const int count : {1, 2}) {
            const Sheet sheet = helpSheet({0, count, tile}, tile);
            EXPECT_EQ(sheet.size().x, tile.x);
            EXPECT_LE(sheet.size().y, tile.y);
            EXPECT_TRUE(tile.x == 1 || inkOf(sheet) > 50) << tile.x;
        }
    }
    // The first entry of two columns, and that there are more.
    const Sheet bar = helpSheet({0, 1, {300, 60}}, {300, 60});
    const std::vector<HelpEntry> all = helpEntries();
    const Face& face = faces().front();
    Sheet line({bar.size().x, face.lineHeight}, {18, 20, 26});
    line.write(face, all.front().keys, {face.size / 2, 0}, {242, 204, 133});
    const auto row = bar.rgb().subspan(static_cast<std::size_t>(3 * bar.size().x * face.size / 2));
    const auto width = static_cast<std::size_t>(3 * (face.size / 2 + textWidth(face, all.front().keys)));
    for (std::size_t y = 0; y < static_cast<std::size_t>(face.lineHeight); ++y) {
        const std::size_t at = y * 3 * static_cast<std::size_t>(bar.size().x);
        EXPECT_TRUE(std::ranges::equal(row.subspan(at, width), line.rgb().subspan(at, width))) << y;
    }
}

TEST(Help, IsInTheLowestRow) {
    const walls::Wall tiled = wallNamed("tiled_3x4");
    int shown = 0;
    for (const walls::Tile& tile : tiled.tiles) {
        const auto place = helpPlaceOf(tiled, tile);
        EXPECT_EQ(place.has_value(), tile.row == tiled.grid->rows) << tile.name;
        if (place) {
            EXPECT_EQ(place->index, shown++);
            EXPECT_EQ(place->count, tiled.grid->columns);
        }
    }
    EXPECT_EQ(shown, tiled.grid->columns);
    const walls::Wall desk = wallNamed("desktop");
    EXPECT_EQ(helpPlaceOf(desk, desk.tiles[0])->count, 1);
}

TEST(Answer, FitsTheTileAndIsAboveTheHelp) {
    for (const glm::ivec2 tile : {glm::ivec2(1, 1), glm::ivec2(160, 120), glm::ivec2(1280, 720)}) {
        for (const std::string& text : {std::string("undone"), std::string(200, 'm')}) {
            const Sheet sheet = answerSheet(tile, text);
            EXPECT_LE(sheet.size().x, tile.x);
            EXPECT_LE(sheet.size().y, tile.y);
            const glm::ivec2 corner = answerCorner(tile, sheet.size(), tile.y / 4);
            EXPECT_GE(corner.x, 0);
            EXPECT_GE(corner.y, 0);
            EXPECT_TRUE(tile.y < 100 || corner.y + sheet.size().y <= tile.y - tile.y / 4);
        }
    }
}

}  // namespace
}  // namespace render_node
