// SPDX-License-Identifier: Apache-2.0
#include "render_node/overlay/help.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "lockstep/key_list.hpp"

namespace render_node {
namespace {

constexpr glm::u8vec3 kHelpBack{18, 20, 26}, kHelpEdge{158, 128, 84}, kHelpKeys{242, 204, 133},
    kHelpText{224, 227, 232};

// Heights of tiles over the sizes of letters.
constexpr int kLinesOfHelp = 45, kLinesOfAnswers = 30;

/// Columns of the help: the entries go down the first column, then down the second one.
struct HelpColumns {
    int keys = 0, effects = 0;  // [pixel], widths of the longest texts
    int count = 1, rows = 0;
    int padding = 0;  // [pixel]
    [[nodiscard]] int height(const Face& face) const { return rows * face.lineHeight + 2 * padding; }
};

HelpColumns columnsOf(std::span<const HelpEntry> entries, const Face& face, int width) {
    HelpColumns columns;
    for (const HelpEntry& entry : entries) {
        columns.keys = std::max(columns.keys, textWidth(face, entry.keys));
        columns.effects = std::max(columns.effects, textWidth(face, entry.effect));
    }
    columns.padding = face.size / 2;
    const int pitch = columns.keys + columns.effects + 3 * face.size;
    columns.count = std::max(1, (width - 2 * columns.padding + 2 * face.size) / pitch);
    columns.rows = (static_cast<int>(entries.size()) + columns.count - 1) / columns.count;
    return columns;
}

bool fits(std::span<const HelpEntry> entries, const Face& face, glm::ivec2 tile) {
    const HelpColumns columns = columnsOf(entries, face, tile.x);
    return columns.keys + columns.effects + face.size + 2 * columns.padding <= tile.x &&
           5 * columns.height(face) <= 3 * tile.y;
}

/// Returns the largest face up to the usual one in which the entries take at most three fifths of a tile; null if there
/// is none.
const Face* faceToFit(std::span<const HelpEntry> entries, glm::ivec2 tile) {
    const Face* best = nullptr;
    for (const Face& face : faces()) {
        if (face.size <= faceFor(tile.y / kLinesOfHelp).size && fits(entries, face, tile)) {
            best = &face;
        }
    }
    return best;
}

bool sameHeight(const walls::Tile& a, const walls::Tile& b) {
    const auto low = [](const walls::Tile& tile) {
        return std::min(tile.screen.lowerLeft.y, tile.screen.lowerRight.y);
    };
    return std::abs(low(a) - low(b)) < 0.1 * a.screen.height();
}

}  // namespace

std::vector<HelpEntry> helpEntries() {
    std::vector<HelpEntry> entries;
    for (const lockstep::MouseEntry& entry : lockstep::mouseList()) {
        entries.push_back({std::string(entry.input), std::string(entry.effect)});
    }
    for (const lockstep::KeyEntry& entry : lockstep::keyList()) {
        entries.push_back({keyNames(entry), std::string(entry.effect)});
    }
    return entries;
}

std::optional<HelpPlace> helpPlaceOf(const walls::Wall& wall, const walls::Tile& tile) {
    const auto lower = [&](const walls::Tile& a, const walls::Tile& b) {
        return wall.grid ? a.row > b.row : a.screen.lowerLeft.y < b.screen.lowerLeft.y;
    };
    const walls::Tile& lowest = *std::ranges::min_element(wall.tiles, lower);
    HelpPlace place{0, 0, lowest.pixels};
    bool found = false;
    for (const walls::Tile& other : wall.tiles) {
        if (wall.grid ? other.row == lowest.row : sameHeight(other, lowest)) {
            if (other.rank == tile.rank) {
                place.index = place.count;
                found = true;
            }
            ++place.count;
            place.smallest = glm::min(place.smallest, other.pixels);
        }
    }
    return found ? std::optional(place) : std::nullopt;
}

Sheet helpSheet(const HelpPlace& place, glm::ivec2 tile) {
    const std::vector<HelpEntry> all = helpEntries();
    std::span<const HelpEntry> entries(all);
    const Face* face = faceToFit(entries, place.smallest);
    if (face == nullptr) {
        const auto share =
            (all.size() + static_cast<std::size_t>(place.count) - 1) / static_cast<std::size_t>(place.count);
        const auto first = std::min(all.size(), share * static_cast<std::size_t>(place.index));
        face = faceToFit(entries.first(share), place.smallest);
        entries = entries.subspan(first, std::min(share, all.size() - first));
    }
    if (face == nullptr || entries.empty()) {
        return {{tile.x, 0}, kHelpBack};
    }
    const HelpColumns columns = columnsOf(entries, *face, tile.x);
    Sheet sheet({tile.x, columns.height(*face)}, kHelpBack);
    sheet.fill({0, 0}, {tile.x, std::max(1, face->size / 12)}, kHelpEdge);
    const int pitch = (tile.x - 2 * columns.padding) / columns.count;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const int column = static_cast<int>(i) / columns.rows, row = static_cast<int>(i) % columns.rows;
        const glm::ivec2 corner(columns.padding + column * pitch, columns.padding + row * face->lineHeight);
        sheet.write(*face, entries[i].keys, corner, kHelpKeys);
        sheet.write(*face, entries[i].effect, corner + glm::ivec2(columns.keys + face->size, 0), kHelpText);
    }
    return sheet;
}

Sheet answerSheet(glm::ivec2 tile, const std::string& text) {
    const auto width = [&](const Face& face) { return textWidth(face, text) + 2 * face.size; };
    const Face* best = &faces().front();
    for (const Face& face : faces()) {
        if (face.size <= faceFor(tile.y / kLinesOfAnswers).size && width(face) <= tile.x) {
            best = &face;
        }
    }
    Sheet sheet({std::min(width(*best), tile.x), std::min(best->lineHeight + best->size / 2, tile.y)}, kHelpBack);
    const int edge = std::max(1, best->size / 12);
    sheet.fill({0, 0}, sheet.size(), kHelpEdge);
    sheet.fill({edge, edge}, sheet.size() - 2 * edge, kHelpBack);
    sheet.write(*best, text, {best->size, best->size / 4}, kHelpText);
    return sheet;
}

glm::ivec2 answerCorner(glm::ivec2 tile, glm::ivec2 answer, int below) {
    const int margin = tile.y / kLinesOfAnswers;
    return {(tile.x - answer.x) / 2, std::max(0, tile.y - below - margin - answer.y)};
}

}  // namespace render_node
