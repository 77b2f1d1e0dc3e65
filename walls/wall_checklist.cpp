// SPDX-License-Identifier: Apache-2.0
#include "walls/wall_checklist.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "walls/projection.hpp"
#include "walls/wall_check.hpp"
#include "walls/wall_measure.hpp"

namespace walls {
namespace {

constexpr double kSameLength = 1e-9;  // [m], largest rounding error of a sum of lengths

std::string line(const char* what, const std::string& found) { return fmt::format("  {:<9} {}\n", what, found); }

std::string counted(std::size_t count, const std::string& what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string eyesLine(const Wall& wall) {
    std::string eyes;
    std::size_t outputs = 0;
    double nearest = HUGE_VAL;
    const Tile* closest = nullptr;
    for (const Eye eye : eyesOf(wall.stereo)) {
        eyes += (eyes.empty() ? "" : " and ") + std::string(eyeName(eye));
    }
    for (const Tile& tile : wall.tiles) {
        outputs += tile.outputs.size();
        for (const Eye eye : eyesOf(wall.stereo)) {
            const double distance = tile.screen.distanceTo(eyePosition(wall.viewer, eye));
            if (distance < nearest) {
                nearest = distance;
                closest = &tile;
            }
        }
    }
    return line("eyes", fmt::format("{} on every tile, {}; in front of all tiles, {:.3f} m before the plane of '{}' at "
                                    "the nearest",
                                    eyes, counted(outputs, "output"), nearest, closest->name));
}

std::string gapText(const Gaps& gaps, double bezel, const char* direction) {
    const double off = std::max({std::abs(gaps.least - bezel), std::abs(gaps.most - bezel), gaps.aslant});
    if (gaps.count > 0 && off > kSameLength) {
        throw std::logic_error(fmt::format("gaps {} measure {} to {} m and {} aslant; the grid has a bezel of {}",
                                           direction, gaps.least, gaps.most, gaps.aslant, bezel));
    }
    return gaps.count == 0 ? fmt::format("none {}", direction)
                           : fmt::format("{} {} of {:.1f} mm", gaps.count, direction, std::abs(gaps.least) * 1000);
}

std::string gapsLine(const Grid& grid, const Wall& wall) {
    const auto [across, down] = gapsOf(wall);
    const bool overlap = std::min(grid.bezel.x, grid.bezel.y) < 0;
    return line(overlap ? "overlaps" : "gaps",
                fmt::format("measured {}, {}: as the grid says", gapText(across, grid.bezel.x, "across"),
                            gapText(down, grid.bezel.y, "down")));
}

std::string pixelsLine(const Wall& wall) {
    double worst = 0;
    bool stretched = false;
    for (const Tile& tile : wall.tiles) {
        worst = std::max(worst, std::abs(pixelShape(tile) / rightPixelShape(wall.stereo, tile) - 1));
        stretched = stretched || isStretched(wall.stereo, tile);
    }
    const char* shape = !stretched                          ? "square"
                        : wall.stereo == Stereo::sideBySide ? "twice as wide as high (the display stretches halves)"
                                                            : "twice as high as wide (the display stretches halves)";
    return line("pixels", fmt::format("{} within {:.2f} %", shape, worst * 100));
}

std::string contactLines(const Wall& wall) {
    std::string lines;
    for (const Tile& tile : wall.tiles) {
        for (const Tile& other : wall.tiles) {
            if (tile.row == 0 && other.rank < tile.rank && contactOf(tile.screen, other.screen) != Contact::none) {
                lines += line("overlaps", fmt::format("'{}' lies on '{}', as the file says", tile.name, other.name));
            }
        }
    }
    return lines.empty() ? line("screens", "none lies on another tile or passes through it") : lines;
}

std::string seamLines(const Wall& wall) {
    std::string lines;
    for (const Seam& seam : seamsOf(wall)) {
        lines += line("joint",
                      fmt::format("{} edge of '{}' and {} edge of '{}': {:.1f} mm apart, at {:.1f} degrees",
                                  edgeName(seam.edgeOfFirst), wall.tiles[seam.first].name, edgeName(seam.edgeOfSecond),
                                  wall.tiles[seam.second].name, seam.apart * 1000, seam.degrees));
    }
    return lines;
}

std::string placesLine(const Wall& wall) {
    std::map<std::string, std::size_t> hosts;
    for (const Tile& tile : wall.tiles) {
        ++hosts[tile.place.host];
    }
    std::string text;
    for (const auto& [host, tiles] : hosts) {
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", counted(tiles, "tile"),
                            host.empty() ? "wherever mpirun puts them" : "on " + host);
    }
    return line("places", text);
}

}  // namespace

std::string checklist(const Wall& wall) {
    std::string text = "checked\n";
    text += line("ranks", fmt::format("{} for the tiles; with the master, {}", wall.ranks(),
                                      fmt::format("{} processes", wall.ranks() + 1)));
    text += eyesLine(wall);
    if (wall.grid && wall.grid->rows * wall.grid->columns > 1) {
        text += gapsLine(*wall.grid, wall);
    }
    text += pixelsLine(wall) + line("corners", "at right angles, and given as the viewer sees them") +
            contactLines(wall) + seamLines(wall) + placesLine(wall);
    return text;
}

}  // namespace walls
