// SPDX-License-Identifier: Apache-2.0
#include "render_node/overlay/help.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "lockstep/key_list.hpp"

namespace render_node {
namespace {

constexpr glm::u8vec3 kHelpBack{18, 20, 26}, kHelpEdge{158, 128, 84}, kHelpKeys{242, 204, 133},
    kHelpText{224, 227, 232};

// Heights of tiles over the sizes of letters.
constexpr int kLinesOfHelp = 45, kLinesOfAnswers = 30;
constexpr int kReadable = 13;  // [pixel], size of letters that only a text without room goes below

const Face& usualFace(int tileHeight, int lines) { return faceFor(std::max(kReadable, tileHeight / lines)); }

/// Columns of the help: the entries go down the first column, then down the second one.
struct HelpColumns {
    int rows = 0;
    std::vector<int> keys, effects;  // [pixel], of each column, widths of the longest texts
};

int paddingOf(const Face& face) { return face.size / 2; }
int heightOf(const Face& face, int rows) { return rows * face.lineHeight + 2 * paddingOf(face); }

int widthOf(const HelpColumns& columns, const Face& face) {
    const int gaps = 3 * static_cast<int>(columns.keys.size()) - 2;  // one after the keys, two between columns
    const int texts = std::accumulate(columns.keys.begin(), columns.keys.end(), 0) +
                      std::accumulate(columns.effects.begin(), columns.effects.end(), 0);
    return texts + gaps * face.size + 2 * paddingOf(face);
}

HelpColumns columnsOf(std::span<const HelpEntry> entries, const Face& face, int rows) {
    const auto height = static_cast<std::size_t>(rows), count = (entries.size() + height - 1) / height;
    HelpColumns columns{rows, std::vector<int>(count), std::vector<int>(count)};
    for (std::size_t i = 0; i < entries.size(); ++i) {
        int& keys = columns.keys[i / height];
        int& effects = columns.effects[i / height];
        keys = std::max(keys, textWidth(face, entries[i].keys));
        effects = std::max(effects, textWidth(face, entries[i].effect));
    }
    return columns;
}

/// Returns as many columns as are possible in this width, and at least one.
HelpColumns columnsIn(std::span<const HelpEntry> entries, const Face& face, int width) {
    const int all = static_cast<int>(entries.size());
    for (int rows = 1; rows < all; ++rows) {
        HelpColumns columns = columnsOf(entries, face, rows);
        if (widthOf(columns, face) <= width) {
            return columns;
        }
    }
    return columnsOf(entries, face, std::max(1, all));
}

/// Contents of each tile of the row.
using Shares = std::vector<std::span<const HelpEntry>>;

/// Returns the rows of the share that needs most of them, so that all bars have the same height.
int rowsOf(const Shares& shares, const Face& face, int width) {
    int rows = 1;
    for (const std::span<const HelpEntry> entries : shares) {
        rows = std::max(rows, columnsIn(entries, face, width).rows);
    }
    return rows;
}

bool fits(const Shares& shares, const Face& face, glm::ivec2 room) {
    const int rows = rowsOf(shares, face, room.x);
    return heightOf(face, rows) <= room.y && std::ranges::all_of(shares, [&](std::span<const HelpEntry> entries) {
               return widthOf(columnsOf(entries, face, rows), face) <= room.x;
           });
}

/// Returns the largest face from `least` to `most` pixels in which each share fits into `room`. Returns null if
/// no such face has room.
const Face* faceToFit(const Shares& shares, int least, int most, glm::ivec2 room /* [pixel] */) {
    const Face* best = nullptr;
    for (const Face& face : faces()) {
        if (face.size >= least && face.size <= most && fits(shares, face, room)) {
            best = &face;
        }
    }
    return best;
}

Shares dividedAmong(std::span<const HelpEntry> entries, int tiles) {
    const auto count = static_cast<std::size_t>(tiles), share = (entries.size() + count - 1) / count;
    Shares shares;
    for (std::size_t first = 0; first < entries.size(); first += share) {
        shares.push_back(entries.subspan(first, std::min(share, entries.size() - first)));
    }
    return shares;
}

/// Returns the first entries, as many as have room in the smallest letters, and a last one that says that there are
/// more.
std::vector<HelpEntry> firstOnes(std::span<const HelpEntry> entries, glm::ivec2 tile) {
    const Face& face = faces().front();
    const int rows = std::max(1, (tile.y - 2 * paddingOf(face)) / face.lineHeight);
    for (std::size_t count = entries.size(); count > 0; --count) {
        std::vector<HelpEntry> first(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(count));
        if (count < entries.size()) {
            first.push_back({"…", "more in a larger window"});
        }
        if (columnsIn(first, face, tile.x).rows <= rows) {
            return first;
        }
    }
    return {entries.front()};
}

Sheet sheetOf(std::span<const HelpEntry> entries, const Face& face, int rows, glm::ivec2 tile) {
    const HelpColumns columns = columnsOf(entries, face, rows);
    Sheet sheet({tile.x, std::min(heightOf(face, columns.rows), tile.y)}, kHelpBack);
    sheet.fill({0, 0}, {tile.x, std::max(1, face.size / 12)}, kHelpEdge);
    // The columns share the width that remains, and the last one has a part of it on its right.
    const int count = static_cast<int>(columns.keys.size());
    const int more = std::max(0, tile.x - widthOf(columns, face)) / std::max(1, count);
    int left = paddingOf(face);
    for (int column = 0, i = 0; column < count; ++column) {
        const auto at = static_cast<std::size_t>(column);
        for (int row = 0; row < columns.rows && i < static_cast<int>(entries.size()); ++row, ++i) {
            const HelpEntry& entry = entries[static_cast<std::size_t>(i)];
            const glm::ivec2 corner(left, paddingOf(face) + row * face.lineHeight);
            sheet.write(face, entry.keys, corner, kHelpKeys);
            sheet.write(face, entry.effect, corner + glm::ivec2(columns.keys[at] + face.size, 0), kHelpText);
        }
        left += columns.keys[at] + columns.effects[at] + 3 * face.size + more;
    }
    return sheet;
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
    const int most = usualFace(place.smallest.y, kLinesOfHelp).size;
    const Shares whole{all}, divided = dividedAmong(all, place.count);
    const glm::ivec2 lowPart(place.smallest.x, 7 * place.smallest.y / 10);
    for (const int least : {kReadable, faces().front().size}) {
        for (const glm::ivec2 room : {lowPart, place.smallest}) {
            for (const Shares& shares : {whole, divided}) {
                if (const Face* face = faceToFit(shares, least, most, room)) {
                    const std::size_t index = shares.size() == 1 ? 0 : static_cast<std::size_t>(place.index);
                    const auto entries = index < shares.size() ? shares[index] : std::span<const HelpEntry>();
                    return sheetOf(entries, *face, rowsOf(shares, *face, place.smallest.x), tile);
                }
            }
        }
    }
    const std::vector<HelpEntry> first = firstOnes(all, tile);
    const Face& smallest = faces().front();
    return sheetOf(first, smallest, columnsIn(first, smallest, tile.x).rows, tile);
}

Sheet answerSheet(glm::ivec2 tile, const std::string& text) {
    const auto width = [&](const Face& face) { return textWidth(face, text) + 2 * face.size; };
    const Face* best = &faces().front();
    for (const Face& face : faces()) {
        if (face.size <= usualFace(tile.y, kLinesOfAnswers).size && width(face) <= tile.x) {
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
