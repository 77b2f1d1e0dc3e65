// SPDX-License-Identifier: Apache-2.0
#include "walls/wall_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <queue>
#include <utility>

#include "walls/wall_measure.hpp"

namespace walls {
namespace {

constexpr int kWidestMap = 12;  // [tile]; so many columns fit into a hundred letters

using Cell = std::pair<int, int>;  // row from the top, column

/// Returns the boxes of the grid as the viewer sees them. Omits the columns of a wide grid beyond kWidestMap.
std::string gridMap(const Grid& grid) {
    const int columns = std::min<int>(grid.columns, kWidestMap);
    std::string rule = "  ";
    for (int column = 0; column < columns; ++column) {
        rule += "+------";
    }
    rule += columns < grid.columns ? "+ ...\n" : "+\n";
    std::string map = rule;
    for (int row = 0; row < grid.rows; ++row) {
        map += "  ";
        for (int column = 0; column < columns; ++column) {
            map += fmt::format("|{:^6}", row * grid.columns + column + 1);
        }
        map += "|\n" + rule;
    }
    return map;
}

Cell beyond(Cell cell, Edge edge) {
    switch (edge) {
        case Edge::left:
            return {cell.first, cell.second - 1};
        case Edge::right:
            return {cell.first, cell.second + 1};
        case Edge::bottom:
            return {cell.first + 1, cell.second};
        case Edge::top:
            break;
    }
    return {cell.first - 1, cell.second};
}

/// Returns the index of the explicit screen without a place that the viewer faces most, or the number of tiles if all
/// have one.
std::size_t frontOf(const Wall& wall, const std::map<std::size_t, Cell>& placed) {
    const glm::dvec3 forward = glm::cross(glm::dvec3(0, 1, 0), wall.viewer.right);
    std::size_t best = wall.tiles.size();
    for (std::size_t i = 0; i < wall.tiles.size(); ++i) {
        const auto facing = [&](std::size_t tile) { return -glm::dot(wall.tiles[tile].screen.normal(), forward); };
        // The small margin chooses the first of equal screens.
        if (wall.tiles[i].row == 0 && !placed.contains(i) &&
            (best == wall.tiles.size() || facing(i) > facing(best) + 1e-9)) {
            best = i;
        }
    }
    return best;
}

/// Returns the cell of each explicit screen. Joined screens are beside each other. A screen that joins no placed screen
/// starts another row.
std::map<std::size_t, Cell> unfolded(const Wall& wall) {
    const std::vector<Seam> seams = seamsOf(wall);
    std::map<std::size_t, Cell> placed;
    std::map<Cell, std::size_t> taken;
    const auto place = [&](std::size_t tile, Cell cell) {
        placed[tile] = cell;
        taken[cell] = tile;
    };
    for (std::size_t front = frontOf(wall, placed); front < wall.tiles.size(); front = frontOf(wall, placed)) {
        // Starts a row below all others. Leaves one row free for a screen that joins above.
        place(front, {taken.empty() ? 0 : taken.rbegin()->first.first + 2, 0});
        std::queue<std::size_t> next({front});
        for (; !next.empty(); next.pop()) {
            for (const Seam& seam : seams) {
                const bool forth = seam.first == next.front();
                if (!forth && seam.second != next.front()) {
                    continue;
                }
                const std::size_t other = forth ? seam.second : seam.first;
                const Cell cell = beyond(placed[next.front()], forth ? seam.edgeOfFirst : seam.edgeOfSecond);
                if (wall.tiles[other].row == 0 && !placed.contains(other) && !taken.contains(cell)) {
                    place(other, cell);
                    next.push(other);
                }
            }
        }
    }
    return placed;
}

std::string screenMap(const Wall& wall) {
    std::map<int, std::map<int, std::string>> rows;
    std::size_t width = 6;
    int first = 0;
    for (const auto& [tile, cell] : unfolded(wall)) {
        std::string label = fmt::format(" {} {} ", wall.tiles[tile].rank, wall.tiles[tile].name);
        width = std::max(width, label.size());
        first = std::min(first, cell.second);
        rows[cell.first][cell.second] = std::move(label);
    }
    std::string map;
    for (const auto& [row, cells] : rows) {
        std::string rule = "  ", middle = "  ";
        for (int column = first; column <= cells.rbegin()->first; ++column) {
            const auto cell = cells.find(column);
            const bool here = cell != cells.end();
            rule += here ? fmt::format("+{:-<{}}+", "", width) : std::string(width + 2, ' ');
            middle += here ? fmt::format("|{:^{}}|", cell->second, width) : std::string(width + 2, ' ');
        }
        map += fmt::format("{0}\n{1}\n{0}\n", rule, middle);
    }
    return map;
}

}  // namespace

std::string textMap(const Wall& wall) { return (wall.grid ? gridMap(*wall.grid) : "") + screenMap(wall); }

}  // namespace walls
