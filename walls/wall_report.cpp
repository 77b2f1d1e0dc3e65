// SPDX-License-Identifier: Apache-2.0
#include "walls/wall_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "walls/canvas.hpp"
#include "walls/projection.hpp"

namespace walls {
namespace {

constexpr int kWidestMap = 12;  // [tile]: a hundred columns of text hold no more

std::string point(glm::dvec3 p) { return fmt::format("({:.3f}, {:.3f}, {:.3f})", p.x, p.y, p.z); }

/// Boxes as the viewer sees them; the columns of a wide grid are left out beyond kWidestMap.
std::string gridMap(const Wall& wall) {
    const Grid& grid = *wall.grid;
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

std::string screenMap(const Wall& wall) {
    std::string map;
    for (const Tile& tile : wall.tiles) {
        if (tile.row == 0) {
            map += fmt::format("  [{} {}]", tile.rank, tile.name);
        }
    }
    return map.empty() ? map : map + "\n";
}

/// The angle between two edges of the screen as the eye sees it [degree].
double angleOf(double low, double high, double near) {
    return glm::degrees(std::atan(high / near) - std::atan(low / near));
}

std::string tileLine(const Wall& wall, const Tile& tile) {
    const View view = viewOf(wall, tile, Eye::middle);
    std::string outputs;
    for (const Output& output : tile.outputs) {
        outputs += (outputs.empty() ? "" : ", ") + output.name;
    }
    return fmt::format("{:>6}  {:<10} {:>11} {:>15} {:>9.3f} {:>11.3f} {:>13}  {}  {}\n", tile.rank, tile.name,
                       fmt::format("{}x{}", tile.pixels.x, tile.pixels.y),
                       fmt::format("{:.3f} x {:.3f}", tile.screen.width(), tile.screen.height()),
                       tile.screen.width() / tile.pixels.x * 1000, tile.screen.distanceTo(wall.viewer.eye),
                       fmt::format("{:.1f} x {:.1f}", angleOf(view.left, view.right, view.near),
                                   angleOf(view.bottom, view.top, view.near)),
                       point(tile.screen.lowerLeft), outputs);
}

/// Whether the sand, taken as a square field, lies between the clipping planes of the screens that show it.
std::string stageLines(const Wall& wall) {
    const glm::dmat4 toRoom = stageToRoom(wall.stage, 1, 1, 0);
    std::string lines =
        fmt::format("sand: {:.3f} m wide, centre {}, tilted {} degrees, turned {}; corners if square:\n",
                    wall.stage.width, point(wall.stage.centre), wall.stage.tiltDegrees, wall.stage.turnDegrees);
    constexpr std::array<const char*, 4> kCorners{"south-west", "south-east", "north-west", "north-east"};
    for (std::size_t i = 0; i < kCorners.size(); ++i) {
        const glm::dvec4 corner = toRoom * glm::dvec4(i % 2 == 1 ? 1.0 : 0.0, i >= 2 ? 1.0 : 0.0, 0, 1);
        std::string seen;
        for (const Tile& tile : wall.tiles) {
            const glm::dvec4 c = viewOf(wall, tile, Eye::middle).viewProjection * corner;
            if (c.w > 0 && std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)}) <= c.w) {
                seen += (seen.empty() ? "" : ", ") + tile.name;
            }
        }
        lines +=
            fmt::format("  {} {}  on {}\n", kCorners.at(i), point(glm::dvec3(corner)), seen.empty() ? "no tile" : seen);
    }
    return lines;
}

}  // namespace

std::string describe(const Wall& wall) {
    const Canvas canvas = wallCanvas(wall);
    std::size_t outputs = 0;
    for (const Tile& tile : wall.tiles) {
        outputs += tile.outputs.size();
    }
    const std::string mode = wall.stereo == Stereo::mono ? "mono" : fmt::format("{} stereo", stereoName(wall.stereo));
    std::string text =
        fmt::format("{}: {} render rank{}, {}, {} output{}, whole picture {}x{} pixels\n", wall.name, wall.ranks(),
                    wall.ranks() == 1 ? "" : "s", mode, outputs, outputs == 1 ? "" : "s", canvas.width, canvas.height);
    text += fmt::format("viewer: eye {}, eyes {:.1f} mm apart; drawn from {} to {} m\n\n", point(wall.viewer.eye),
                        wall.viewer.eyeSeparation * 1000, wall.clip.near, wall.clip.far);
    if (wall.grid) {
        text += gridMap(wall);
        text += fmt::format("  bezels {:.1f} x {:.1f} mm\n", wall.grid->bezel.x * 1000, wall.grid->bezel.y * 1000);
    }
    text += screenMap(wall);
    text += fmt::format("\n{:>6}  {:<10} {:>11} {:>15} {:>9} {:>11} {:>13}  {}\n", "rank", "tile", "pixels", "metres",
                        "mm/pixel", "distance m", "degrees", "lower left, outputs");
    for (const Tile& tile : wall.tiles) {
        text += tileLine(wall, tile);
    }
    return text + "\n" + stageLines(wall);
}

}  // namespace walls
