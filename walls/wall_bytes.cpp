// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <set>

#include "walls/wall.hpp"
#include "walls/wall_check.hpp"

namespace walls {
namespace {

std::string pixelRefusal(glm::ivec2 pixels) {
    const bool possible = pixels.x >= 1 && pixels.y >= 1 && pixels.x <= kMaxTileSide && pixels.y <= kMaxTileSide;
    return possible ? "" : fmt::format("a tile of {}x{} pixels", pixels.x, pixels.y);
}

/// Returns why the outputs and their eyes are not those of the wall's stereo mode, or an empty text. A rank draws by
/// them.
std::string outputRefusal(const Wall& wall, const Tile& tile) {
    const std::vector<Output> expected = outputsOf(wall.stereo, tile.name, wall.swapEyes);
    if (tile.outputs.size() != expected.size()) {
        return "has outputs of another stereo";
    }
    for (std::size_t i = 0; i < expected.size(); ++i) {
        if (tile.outputs[i].name != expected[i].name || tile.outputs[i].eyes != expected[i].eyes) {
            return "shows eyes of another stereo";
        }
    }
    return "";
}

/// Returns why the tile is at another place of the wall than its rank says, or an empty text.
std::string placeRefusal(const Wall& wall, const Tile& tile) {
    if (tile.row == 0 && tile.column == 0) {
        return isTileName(tile.name) ? "" : "has no fit name";
    }
    const bool inGrid = wall.grid && tile.row >= 1 && tile.row <= wall.grid->rows && tile.column >= 1 &&
                        tile.column <= wall.grid->columns &&
                        tile.rank == (tile.row - 1) * wall.grid->columns + tile.column &&
                        tile.name == fmt::format("r{}c{}", tile.row, tile.column);
    return inGrid ? "" : "is out of its grid";
}

}  // namespace

std::string Viewer::refusal() const {
    if (!(eyeSeparation > 0 && eyeSeparation <= kMaxEyeSeparation)) {
        return fmt::format("eyes {} m apart", eyeSeparation);
    }
    return std::abs(glm::length(right) - 1) < 1e-9 ? "" : "right is not a unit vector";
}

std::string Clip::refusal() const {
    return near > 0 && far > near ? "" : fmt::format("planes at {} and {} m", near, far);
}

std::string Stage::refusal() const { return width > 0 ? "" : fmt::format("a field of {} m", width); }

std::string Grid::refusal() const {
    const bool sized = tileSize.x > 0 && tileSize.y > 0 && !glm::any(glm::greaterThan(bezel, tileSize)) &&
                       !glm::any(glm::lessThanEqual(tileSize + bezel, glm::dvec2(0)));
    return sized ? pixelRefusal(tilePixels)
                 : fmt::format("tiles of {} x {} m with bezels of {} x {} m", tileSize.x, tileSize.y, bezel.x, bezel.y);
}

std::string Tile::refusal() const {
    const auto fault = [this](const char* what) { return fmt::format("the tile of rank {} {}", rank, what); };
    if (!(screen.width() > 0 && screen.height() > 0)) {
        return fault("has no size");
    }
    if (!(std::abs(glm::dot(screen.right(), screen.up())) < 1e-6)) {
        return fault("is not a rectangle");
    }
    for (const Output& output : outputs) {
        if (!output.monitor.empty() && output.window) {
            return fault("has a monitor and a window at once");
        }
        if (!isOneLine(output.monitor, kMaxTracking)) {
            return fault("has a monitor without a name");
        }
    }
    return pixelRefusal(pixels);
}

std::string Wall::refusal() const {
    if (!(refreshHz >= kMinRefresh && refreshHz <= kMaxRefresh)) {
        return fmt::format("{} frames per second", refreshHz);
    }
    if (!isOneLine(tracking, kMaxTracking)) {
        return "tracking is not one line";
    }
    const std::int64_t gridTiles = grid ? std::int64_t{grid->rows} * grid->columns : 0;
    if (tiles.empty() || static_cast<std::int64_t>(tiles.size()) < gridTiles) {
        return fmt::format("{} tiles", tiles.size());
    }
    std::set<std::string> names;
    for (const Tile& tile : tiles) {
        std::string fault = placeRefusal(*this, tile);
        fault = fault.empty() ? outputRefusal(*this, tile) : fault;
        fault = tile.rank == static_cast<int>(names.size()) + 1 ? fault : "is out of order";
        fault = names.insert(tile.name).second ? fault : "has the name of another";
        if (!fault.empty()) {
            return fmt::format("the tile of rank {} {}", tile.rank, fault);
        }
    }
    return "";
}

base::Bytes Wall::encode() const { return base::encoded(*this); }

Wall Wall::decode(std::span<const std::uint8_t> bytes) { return base::decoded<Wall>(bytes); }

}  // namespace walls
