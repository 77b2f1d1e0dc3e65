// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include "sand/grid/dunes.hpp"
#include "sand/tin/refine/start_maker.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace samples {

/// Returns a scene with dunes of 24 x 16 nominal cells as a TIN.
inline scene::Scene tinScene() {
    scene::Scene scene = samples::flatScene(24, 16);
    sand::grid::makeDunes({.bed = 2, .height = 3, .length = 10, .seed = 7}, scene.terrain);
    auto start =
        sand::tin::follow(scene.terrain, nullptr, {.spacing = 300, .maxError = 20000, .mostVertices = 400}).start;
    scene.rules.tin = start.digest();
    scene.tin = std::make_shared<const sand::tin::TinStart>(std::move(start));
    scene.terrain = sand::HeightField(1, 1, scene.terrain.cellSize());
    return scene;
}

}  // namespace samples
