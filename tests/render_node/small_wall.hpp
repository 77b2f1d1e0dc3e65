// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "walls/wall.hpp"

namespace test {

/// Returns a wall of one tile of 80 x 60 pixels before the sample scene.
inline walls::Wall smallWall() {
    walls::Wall wall;
    wall.viewer.eye = {1, 1, 3};
    wall.clip = {0.1, 20};
    walls::Tile tile;
    tile.name = "only";
    tile.screen = {{0, 0.25, 0}, {2, 0.25, 0}, {0, 1.75, 0}};
    tile.pixels = {80, 60};
    tile.outputs = walls::outputsOf(walls::Stereo::mono, tile.name);
    wall.tiles = {tile};
    return wall;
}

}  // namespace test
