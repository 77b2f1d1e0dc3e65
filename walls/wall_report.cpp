// SPDX-License-Identifier: Apache-2.0
#include "walls/wall_report.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "walls/canvas.hpp"
#include "walls/projection.hpp"
#include "walls/stereo_change.hpp"
#include "walls/wall_checklist.hpp"
#include "walls/wall_map.hpp"
#include "walls/wall_units.hpp"

namespace walls {
namespace {

std::string point(glm::dvec3 p) { return fmt::format("({:.3f}, {:.3f}, {:.3f})", p.x, p.y, p.z); }

/// Returns the angle between two edges of the screen as the eye sees it [degree].
double angleOf(double low, double high, double near) {
    return glm::degrees(std::atan(high / near) - std::atan(low / near));
}

std::string outputText(const Output& output, glm::ivec2 frame, glm::ivec2 onePicture) {
    std::string text = output.name;
    for (const Eye eye : output.eyes) {
        text += fmt::format(" {}", eyeName(eye).substr(0, 1));
    }
    if (frame != onePicture) {
        text += fmt::format(" {}x{}", frame.x, frame.y);
    }
    if (!output.monitor.empty()) {
        text += " on " + output.monitor;
    }
    return output.window ? text + fmt::format(" at [{}, {}]", output.window->x, output.window->y) : text;
}

std::string placeText(const Place& place) {
    std::string text = place.host.empty() ? "" : "; host " + place.host;
    text += place.display.empty() ? "" : "; display " + place.display;
    return place.device < 0 ? text : text + fmt::format("; device {}", place.device);
}

std::string tileLine(const Wall& wall, const Tile& tile) {
    const View view = viewOf(wall, tile, Eye::middle);
    std::string outputs;
    for (const Output& output : tile.outputs) {
        outputs +=
            (outputs.empty() ? "" : ", ") + outputText(output, outputPixels(wall.stereo, tile.pixels), tile.pixels);
    }
    return fmt::format("{:>6}  {:<10} {:>11} {:>15} {:>9.3f} {:>11.3f} {:>13}  {}  {}\n", tile.rank, tile.name,
                       fmt::format("{}x{}", tile.pixels.x, tile.pixels.y),
                       fmt::format("{:.3f} x {:.3f}", tile.screen.width(), tile.screen.height()),
                       tile.screen.width() / tile.pixels.x * 1000, tile.screen.distanceTo(wall.viewer.eye),
                       fmt::format("{:.1f} x {:.1f}", angleOf(view.left, view.right, view.near),
                                   angleOf(view.bottom, view.top, view.near)),
                       point(tile.screen.lowerLeft), outputs + placeText(tile.place));
}

/// Returns lines with the corners of the sand, taken as a square field, and the tiles that show each corner.
std::string stageLines(const Wall& wall) {
    std::string lines =
        fmt::format("sand: {:.3f} m wide, centre {}, tilted {} degrees, turned {}; corners if square:\n",
                    wall.stage.width, point(wall.stage.centre), wall.stage.tiltDegrees, wall.stage.turnDegrees);
    constexpr std::array<const char*, 4> kCorners{"south-west", "south-east", "north-west", "north-east"};
    const std::array<glm::dvec3, 4> corners = stageCorners(wall.stage);
    for (std::size_t i = 0; i < kCorners.size(); ++i) {
        const std::vector<std::string> seen = tilesShowing(wall, corners.at(i));
        lines += fmt::format("  {} {}  on {}\n", kCorners.at(i), point(corners.at(i)),
                             seen.empty() ? "no tile" : fmt::format("{}", fmt::join(seen, ", ")));
    }
    for (const std::string& warning : unitWarnings(wall)) {
        lines += fmt::format("warning: {}\n", warning);
    }
    if (const auto warning = stageWarning(wall)) {
        lines += fmt::format("warning: {}\n", *warning);
    }
    return lines;
}

}  // namespace

std::string describe(const Wall& wall) {
    const Canvas canvas = wallCanvas(wall);
    const std::size_t outputs = wall.tiles.front().outputs.size() * wall.tiles.size();
    const std::string mode = wall.stereo == Stereo::mono ? "mono"
                                                         : fmt::format("{} stereo{}", stereoName(wall.stereo),
                                                                       wall.swapEyes ? " with swapped eyes" : "");
    std::string text =
        fmt::format("{}: {} render rank{}, {}, {} output{}, whole picture {}x{} pixels\n", wall.name, wall.ranks(),
                    wall.ranks() == 1 ? "" : "s", mode, outputs, outputs == 1 ? "" : "s", canvas.width, canvas.height);
    text += fmt::format("viewer: eye {}, eyes {:.1f} mm apart; drawn from {} to {} m; {} frames per second; head {}\n",
                        point(wall.viewer.eye), wall.viewer.eyeSeparation * 1000, wall.clip.near, wall.clip.far,
                        wall.refreshHz, wall.tracking.empty() ? "not tracked" : "from " + wall.tracking);
    const std::vector<std::string> modes = otherModesOf(wall);
    text += fmt::format("stereo: during a session it can switch to {}\n\n",
                        modes.empty() ? "no other mode" : fmt::format("{}", fmt::join(modes, ", ")));
    text += textMap(wall) + "\n" + checklist(wall);
    text += fmt::format("\n{:>6}  {:<10} {:>11} {:>15} {:>9} {:>11} {:>13}  {}\n", "rank", "tile", "pixels", "metres",
                        "mm/pixel", "distance m", "degrees", "lower left, outputs with their eyes, places");
    for (const Tile& tile : wall.tiles) {
        text += tileLine(wall, tile);
    }
    return text + "\n" + stageLines(wall);
}

std::string hostLines(const Wall& wall) {
    std::string lines;
    for (const Tile& tile : wall.tiles) {
        lines += (tile.place.host.empty() ? "-" : tile.place.host) + "\n";
    }
    return lines;
}

std::string outputsLine(const Wall& wall) {
    std::size_t outputs = 0;
    std::size_t placed = 0;
    for (const Tile& tile : wall.tiles) {
        for (const Output& output : tile.outputs) {
            ++outputs;
            placed += !tile.place.display.empty() || !output.monitor.empty() || output.window.has_value() ? 1 : 0;
        }
    }
    return fmt::format("{} {}\n", outputs, placed);
}

}  // namespace walls
