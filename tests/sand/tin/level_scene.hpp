// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "scene/model/scene.hpp"
#include "tests/support/sand/tin_piles.hpp"

namespace tin_samples {

/// Returns level sand on jittered places, with a talus of 45 degrees and a band of 0.001. A tool adds points at
/// `spacing` [probe unit], or none if it is 0.
inline scene::Scene levelScene(int side /* [cell] */, std::uint32_t seed, std::int32_t spacing = 0) {
    sand::tin::TinStart start = tin_piles::levelStart(side, seed);
    start.settings.spacing = spacing;
    start.settings.maxError = 0;
    start.settings.mostVertices = 1 << 19;
    scene::Scene scene;
    scene.rules.columns = scene.rules.rows = side;
    scene.rules.tuning.threshold = 65536;
    scene.rules.tuning.startThreshold = 65536 + 65536 / 1000;
    scene.tin = std::make_shared<const sand::tin::TinStart>(std::move(start));
    return scene;
}

}  // namespace tin_samples
