// SPDX-License-Identifier: Apache-2.0
#include "walls/desk_windows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <string_view>
#include <vector>

#include "base/input_error.hpp"
#include "walls/wall_check.hpp"
#include "walls/wall_map.hpp"

namespace walls {
namespace {

/// Windows of all tiles, from the top left corner of the smallest rectangle around them [pixel].
struct Layout {
    std::vector<glm::ivec2> corners, sizes;  // of each tile
    glm::ivec2 whole{0};
};

glm::ivec2 scaled(glm::ivec2 pixels, double factor) {
    return glm::max(glm::ivec2(glm::floor(glm::dvec2(pixels) * factor)), glm::ivec2(1));
}

/// Returns the gaps between the windows of the grid [pixel]. Tiles that overlap on the wall touch on a desktop.
glm::ivec2 gapsOf(const Grid& grid, double factor) {
    const glm::dvec2 bezel = grid.bezel / grid.tileSize * glm::dvec2(grid.tilePixels);
    return glm::max(glm::ivec2(glm::floor(bezel * factor)), glm::ivec2(0));
}

void layGrid(const Wall& wall, double factor, Layout& layout) {
    const glm::ivec2 size = scaled(wall.grid->tilePixels, factor);
    const glm::ivec2 pitch = size + gapsOf(*wall.grid, factor);
    for (std::size_t i = 0; i < wall.tiles.size(); ++i) {
        if (wall.tiles[i].row > 0) {
            layout.corners[i] = glm::ivec2(wall.tiles[i].column - 1, wall.tiles[i].row - 1) * pitch;
            layout.sizes[i] = size;
            layout.whole = glm::max(layout.whole, layout.corners[i] + size);
        }
    }
}

/// Returns where each row or column begins that `sizes` names with its largest size. They begin at `from`.
std::map<int, int> beginnings(const std::map<int, int>& sizes, int from, int& end) {
    std::map<int, int> begin;
    for (const auto& [index, size] : sizes) {
        begin[index] = from;
        from += size;
    }
    end = from;
    return begin;
}

/// Lays the explicit screens below the grid. Each is in the middle of its row and column of the map.
void layScreens(const Wall& wall, double factor, Layout& layout) {
    const std::map<std::size_t, MapCell> cells = unfolded(wall);
    std::map<int, int> heights, widths;  // of the rows and columns
    for (const auto& [tile, cell] : cells) {
        layout.sizes[tile] = scaled(wall.tiles[tile].pixels, factor);
        heights[cell.first] = std::max(heights[cell.first], layout.sizes[tile].y);
        widths[cell.second] = std::max(widths[cell.second], layout.sizes[tile].x);
    }
    glm::ivec2 end(0);
    const std::map<int, int> top = beginnings(heights, layout.whole.y, end.y), left = beginnings(widths, 0, end.x);
    for (const auto& [tile, cell] : cells) {
        const glm::ivec2 room(widths[cell.second], heights[cell.first]);
        layout.corners[tile] = glm::ivec2(left.at(cell.second), top.at(cell.first)) + (room - layout.sizes[tile]) / 2;
    }
    layout.whole = glm::max(layout.whole, end);
}

Layout layoutOf(const Wall& wall, double factor) {
    Layout layout{std::vector<glm::ivec2>(wall.tiles.size()), std::vector<glm::ivec2>(wall.tiles.size()), {}};
    if (wall.grid) {
        layGrid(wall, factor, layout);
    }
    layScreens(wall, factor, layout);
    return layout;
}

}  // namespace

DeskArea DeskArea::parse(const std::string& text, const std::string& name) {
    constexpr int kMost = 1 << 20;  // [pixel]
    std::array<int, 4> numbers{};   // width, height, x, y
    constexpr std::string_view kBetween = "x++";
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    bool good = true;
    for (std::size_t i = 0; good && i < numbers.size(); ++i) {
        const std::from_chars_result read = std::from_chars(at, end, numbers.at(i));
        const bool last = i == kBetween.size();
        good = read.ec == std::errc() && numbers.at(i) >= (i < 2 ? 1 : 0) && numbers.at(i) <= kMost &&
               (last ? read.ptr == end : read.ptr != end && *read.ptr == kBetween[i]);
        at = last ? end : read.ptr + 1;
    }
    if (!good) {
        throw base::InputError(fmt::format(
            "{} {}: must be an area of the desktop in pixels, WIDTHxHEIGHT+X+Y, such as 1600x900+0+0", name, text));
    }
    return {{numbers[0], numbers[1]}, {numbers[2], numbers[3]}};
}

Wall placedOnDesk(const Wall& wall, const DeskArea& area, const std::string& file) {
    Wall desk = shownIn(wall, Stereo::mono);
    if (const auto fault = viewFault(desk)) {
        throw base::InputError(fmt::format("{}: shown with one eye on a desktop: {}", file, *fault));
    }
    const glm::dvec2 whole = layoutOf(desk, 1).whole;
    const double factor = std::min({1.0, area.size.x / whole.x, area.size.y / whole.y});
    const Layout layout = layoutOf(desk, factor);
    if (glm::any(glm::greaterThan(layout.whole, area.size))) {
        throw base::InputError(fmt::format(
            "{}: its {} tiles do not fit on a desktop of {}x{} pixels, even at one pixel each; choose another "
            "wall",
            file, desk.ranks(), area.size.x, area.size.y));
    }
    const glm::ivec2 corner = area.corner + (area.size - layout.whole) / 2;
    for (std::size_t i = 0; i < desk.tiles.size(); ++i) {
        Tile& tile = desk.tiles[i];
        tile.pixels = layout.sizes[i];
        tile.place = {};
        tile.outputs.front().monitor.clear();
        tile.outputs.front().window = corner + layout.corners[i];
    }
    if (desk.grid) {
        desk.grid->tilePixels = scaled(desk.grid->tilePixels, factor);
    }
    desk.refreshHz = wall.stereo == Stereo::active ? wall.refreshHz / 2 : wall.refreshHz;
    desk.tracking.clear();
    desk.onDesk = true;
    return desk;
}

}  // namespace walls
