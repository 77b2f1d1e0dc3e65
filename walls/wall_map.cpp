// SPDX-License-Identifier: Apache-2.0
#include "walls/wall_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <utility>

#include "walls/wall_measure.hpp"

namespace walls {
namespace {

constexpr int kWidestMap = 12;  // [tile]; so many columns fit into a hundred letters

/// Returns how far a screen is turned in its own plane, as a viewer who faces it sees it [degree]: counter-clockwise,
/// from -180 to 180. A viewer does not turn to face a floor or a ceiling.
double turnOf(const Wall& wall, const Screen& screen) {
    constexpr double kFlat = 0.9;  // least vertical part of the normal of a floor or a ceiling
    const glm::dvec3 normal = screen.normal(), right = wall.viewer.right;
    const glm::dvec3 level = glm::normalize(std::abs(normal.y) < kFlat ? glm::cross(glm::dvec3(0, 1, 0), normal)
                                                                       : right - normal * glm::dot(normal, right));
    return glm::degrees(
        std::atan2(glm::dot(screen.right(), glm::cross(normal, level)), glm::dot(screen.right(), level)));
}

/// Returns the number of quarter turns counter-clockwise, 0 to 3, that are nearest to `degrees`.
int quartersOf(double degrees) { return (static_cast<int>(std::lround(degrees / 90)) + 4) % 4; }

/// Returns a line for a turned screen; an empty text if its rows are level.
std::string turnLine(double degrees, const std::string& name) {
    constexpr double kLevel = 1;  // [degree]
    return std::abs(degrees) < kLevel
               ? ""
               : fmt::format("  {} is turned by {:.0f} degrees {}\n", name, std::abs(degrees),
                             degrees < 0 && degrees > kLevel - 180 ? "clockwise" : "counter-clockwise");
}

/// Returns the tile of the grid that the viewer faces most. The grid has a tile.
const Tile& middleOf(const Wall& wall) {
    const glm::dvec3 forward = glm::cross(glm::dvec3(0, 1, 0), wall.viewer.right);
    // A screen beside the grid has row 0, and is never the middle.
    const auto away = [&](const Tile& tile) {
        return tile.row == 0 ? std::numeric_limits<double>::infinity() : glm::dot(tile.screen.normal(), forward);
    };
    return *std::ranges::min_element(wall.tiles, {}, away);
}

/// Returns the boxes of the grid as the viewer sees them. Omits the columns of a wide grid beyond kWidestMap.
std::string gridMap(const Wall& wall) {
    const Grid& grid = *wall.grid;
    const double turn = turnOf(wall, middleOf(wall).screen);
    const int quarters = quartersOf(turn);
    const int rows = quarters % 2 == 0 ? grid.rows : grid.columns;
    const int allColumns = quarters % 2 == 0 ? grid.columns : grid.rows;
    const int columns = std::min(allColumns, kWidestMap);
    // The rank of the box in this row and column of the map.
    const auto rankAt = [&](int row, int column) {
        const std::array<MapCell, 4> turned{MapCell{row, column}, MapCell{column, grid.columns - 1 - row},
                                            MapCell{grid.rows - 1 - row, grid.columns - 1 - column},
                                            MapCell{grid.rows - 1 - column, row}};
        const MapCell cell = turned.at(static_cast<std::size_t>(quarters));
        return cell.first * grid.columns + cell.second + 1;
    };
    std::string rule = "  ";
    for (int column = 0; column < columns; ++column) {
        rule += "+------";
    }
    rule += columns < allColumns ? "+ ...\n" : "+\n";
    std::string map = rule;
    for (int row = 0; row < rows; ++row) {
        map += "  ";
        for (int column = 0; column < columns; ++column) {
            map += fmt::format("|{:^6}", rankAt(row, column));
        }
        map += "|\n" + rule;
    }
    return map + turnLine(turn, "the grid");
}

MapCell beyond(MapCell cell, Edge edge) {
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

constexpr std::array<Edge, 4> kCounterClockwise{Edge::right, Edge::top, Edge::left, Edge::bottom};

int numberOf(Edge edge) {
    return static_cast<int>(std::find(kCounterClockwise.begin(), kCounterClockwise.end(), edge) -
                            kCounterClockwise.begin());
}

/// Returns the edge of a screen that the viewer sees at `edge` of a screen with level rows, after quarter turns.
Edge turned(Edge edge, int quarters) {
    return kCounterClockwise.at(static_cast<std::size_t>(numberOf(edge) + quarters) % kCounterClockwise.size());
}

/// Returns the quarter turns after which the viewer sees `edge` of a screen opposite to `other`.
int quartersTowards(Edge edge, Edge other) { return (numberOf(other) + 2 - numberOf(edge) + 4) % 4; }

/// Returns the index of the explicit screen without a place that the viewer faces most, or the number of tiles if all
/// have one.
std::size_t frontOf(const Wall& wall, const std::map<std::size_t, MapCell>& placed) {
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
    for (const Tile& tile : wall.tiles) {
        map += tile.row == 0 ? turnLine(turnOf(wall, tile.screen), tile.name) : "";
    }
    return map;
}

}  // namespace

/// Joined screens are beside each other. A screen that joins no placed screen starts another row.
std::map<std::size_t, MapCell> unfolded(const Wall& wall) {
    const std::vector<Seam> seams = seamsOf(wall);
    std::map<std::size_t, MapCell> placed;
    std::map<MapCell, std::size_t> taken;
    std::map<std::size_t, int> quarters;  // turns of the placed screens in the map
    const auto place = [&](std::size_t tile, MapCell cell, int turns) {
        placed[tile] = cell;
        taken[cell] = tile;
        quarters[tile] = turns;
    };
    for (std::size_t front = frontOf(wall, placed); front < wall.tiles.size(); front = frontOf(wall, placed)) {
        // Starts a row below all others. Leaves one row free for a screen that joins above.
        place(front, {taken.empty() ? 0 : taken.rbegin()->first.first + 2, 0},
              quartersOf(turnOf(wall, wall.tiles[front].screen)));
        std::queue<std::size_t> next({front});
        for (; !next.empty(); next.pop()) {
            for (const Seam& seam : seams) {
                const bool forth = seam.first == next.front();
                if (!forth && seam.second != next.front()) {
                    continue;
                }
                const std::size_t other = forth ? seam.second : seam.first;
                const Edge edge =
                    turned(forth ? seam.edgeOfFirst : seam.edgeOfSecond, quarters[next.front()]);  // in the map
                const MapCell cell = beyond(placed[next.front()], edge);
                if (wall.tiles[other].row == 0 && !placed.contains(other) && !taken.contains(cell)) {
                    place(other, cell, quartersTowards(forth ? seam.edgeOfSecond : seam.edgeOfFirst, edge));
                    next.push(other);
                }
            }
        }
    }
    return placed;
}

std::string textMap(const Wall& wall) { return (wall.grid ? gridMap(wall) : "") + screenMap(wall); }

}  // namespace walls
