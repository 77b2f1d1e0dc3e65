// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sand/model/units.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace samples {

inline constexpr int kHighSide = 64;                                                    // [cell]
inline constexpr std::int32_t kHighLevel = sand::kMaxHeight - 6 * sand::kUnitsPerCell;  // [unit]

/// Returns level sand a few cells below the largest height. The cells around a large tool cannot take its sand.
inline scene::Scene highScene(double toolCells, sand::ToolKind kind = sand::ToolKind::sphere,
                              double cellSize = 1 /* [scene unit] */) {
    scene::Scene scene = flatScene(kHighSide, kHighSide, toolCells);
    scene.terrain = sand::HeightField(kHighSide, kHighSide, cellSize);
    scene.rules.tuning.tool.kind = kind;
    scene.rules.tuning.tool.halfWidth = sand::isRound(kind) ? 0 : scene.rules.tuning.tool.radius / 2;
    for (int row = 0; row < kHighSide; ++row) {
        for (int column = 0; column < kHighSide; ++column) {
            scene.terrain.setHeight(column, row, kHighLevel);
        }
    }
    return scene;
}

/// Returns the middle of the field of highScene(), `above` cells above its sand.
inline sand::ProbePoint aboveHighSand(double above, int column = kHighSide / 2) {
    const double level = static_cast<double>(kHighLevel) / sand::kUnitsPerCell;
    return {column * sand::kProbePerCell, kHighSide / 2 * sand::kProbePerCell,
            static_cast<std::int32_t>((level + above) * sand::kProbePerCell)};
}

}  // namespace samples
