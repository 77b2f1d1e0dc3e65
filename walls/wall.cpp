// SPDX-License-Identifier: Apache-2.0
#include "walls/wall.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/input_error.hpp"

namespace walls {
namespace {

/// Exchanges the eyes of a tile with one output for both eyes, or with one output for each.
void exchangeEyes(std::vector<Output>& outputs) {
    for (Output& output : outputs) {
        std::ranges::reverse(output.eyes);
    }
    if (outputs.size() == 2) {
        std::swap(outputs[0].eyes, outputs[1].eyes);
    }
}

}  // namespace

Stereo stereoNamed(const std::string& name) {
    const auto found = base::valueNamed<Stereo>(name);
    if (!found) {
        throw base::InputError(
            fmt::format("no stereo mode '{}'; there are {}", name, fmt::join(base::namesOf<Stereo>(), ", ")));
    }
    return *found;
}

std::span<const Eye> eyesOf(Stereo stereo) {
    static constexpr std::array<Eye, 2> kBoth{Eye::left, Eye::right};
    static constexpr std::array<Eye, 1> kMiddle{Eye::middle};
    switch (stereo) {
        case Stereo::mono:
            return kMiddle;
        case Stereo::left:
            return std::span(kBoth).first(1);
        case Stereo::right:
            return std::span(kBoth).last(1);
        default:
            return kBoth;
    }
}

bool packsEyes(Stereo stereo) {
    return eyesOf(stereo).size() > 1 && stereo != Stereo::passive && stereo != Stereo::active;
}

glm::ivec2 outputPixels(Stereo stereo, glm::ivec2 eyePixels) {
    switch (stereo) {
        case Stereo::sideBySide:
            return {2 * eyePixels.x, eyePixels.y};
        case Stereo::topBottom:
            return {eyePixels.x, 2 * eyePixels.y};
        default:
            return eyePixels;
    }
}

std::vector<Output> outputsOf(Stereo stereo, const std::string& tileName, bool swapEyes) {
    const std::span<const Eye> eyes = eyesOf(stereo);
    std::vector<Output> outputs{{tileName, {eyes.begin(), eyes.end()}, {}, {}}};
    if (stereo == Stereo::passive) {
        outputs = {{tileName + "_left", {Eye::left}, {}, {}}, {tileName + "_right", {Eye::right}, {}, {}}};
    }
    if (swapEyes) {
        exchangeEyes(outputs);
    }
    return outputs;
}

std::vector<Tile> tilesOf(const Grid& grid, Stereo stereo) {
    std::vector<Tile> tiles;
    const glm::dvec2 pitch = grid.tileSize + grid.bezel;
    for (int row = 1; row <= grid.rows; ++row) {
        for (int column = 1; column <= grid.columns; ++column) {
            Tile tile;
            tile.rank = static_cast<std::int32_t>(tiles.size()) + 1;
            tile.row = row;
            tile.column = column;
            tile.name = fmt::format("r{}c{}", row, column);
            tile.screen.lowerLeft =
                grid.lowerLeft + grid.right * (pitch.x * (column - 1)) + grid.up * (pitch.y * (grid.rows - row));
            tile.screen.lowerRight = tile.screen.lowerLeft + grid.right * grid.tileSize.x;
            tile.screen.upperLeft = tile.screen.lowerLeft + grid.up * grid.tileSize.y;
            tile.pixels = grid.tilePixels;
            tile.outputs = outputsOf(stereo, tile.name);
            tiles.push_back(std::move(tile));
        }
    }
    return tiles;
}

bool isStretched(Stereo stereo, const Tile& tile) {
    const double shape = tile.screen.width() / tile.pixels.x / (tile.screen.height() / tile.pixels.y);
    return (stereo == Stereo::sideBySide && shape > std::sqrt(2.0)) ||
           (stereo == Stereo::topBottom && shape < std::sqrt(0.5));
}

Wall withSwappedEyes(Wall wall, bool swapEyes) {
    if (wall.swapEyes != swapEyes) {
        for (Tile& tile : wall.tiles) {
            exchangeEyes(tile.outputs);
        }
        wall.swapEyes = swapEyes;
    }
    return wall;
}

Wall shownIn(Wall wall, Stereo stereo) {
    for (Tile& tile : wall.tiles) {
        std::vector<Output> outputs = outputsOf(stereo, tile.name, wall.swapEyes);
        for (std::size_t i = 0; i < std::min(outputs.size(), tile.outputs.size()); ++i) {
            outputs[i].monitor = tile.outputs[i].monitor;
            outputs[i].window = tile.outputs[i].window;
        }
        tile.outputs = std::move(outputs);
        if (isStretched(wall.stereo, tile)) {
            tile.pixels = outputPixels(wall.stereo, tile.pixels) / outputPixels(stereo, glm::ivec2(1));
            if (wall.grid && tile.row > 0) {
                wall.grid->tilePixels = tile.pixels;
            }
        }
    }
    wall.stereo = stereo;
    return wall;
}

}  // namespace walls
