// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "scene/import/esri_grid.hpp"
#include "scene/relax/height_scale.hpp"
#include "scene/scene.hpp"

namespace scene::relax {

inline constexpr int kLeastThreshold = 4;  // [unit]: a coarser talus is no angle any more

struct TalusSettings {
    double talusDegrees = 0;  // [degree], in [0, 90)
    double band = 0;          // sand at rest starts to slide this share beyond the talus
    sand::Scheme scheme = sand::Scheme::isotropic;
};

/// A grid from a file, as sand: whole numbers, and what they stand for. Edges without any data are left out: the rim
/// of the sand is where data ends.
struct GridSand {
    sand::CellRect cells;                // of the grid: those that are in the field
    sand::HeightField field;             // walls lie at 0
    std::optional<sand::Ground> ground;  // only where there is bedrock or a cell without data, which is a wall
    sand::Rules rules;                   // rim closed
    HeightScale scale;
    bool onBedrock = false;
    std::int32_t lowest = 0;            // surface at the start [unit]: what volumes are counted from without bedrock
    std::vector<std::string> warnings;  // one line each

    [[nodiscard]] bool isWall(int column, int row) const { return ground && ground->isWall(column, row); }
    /// Of the sand over the bedrock, or over the lowest cell there was [unit · cell].
    [[nodiscard]] std::int64_t volume() const;
    /// The grid it was made from, with the heights of now: those of cells that are as they were come back untouched.
    [[nodiscard]] EsriGrid toGrid(const EsriGrid& before) const;
};

/// Throws base::InputError with file, line, value and range: no data at all, cells more oblong than 1 to 1000, heights
/// that do not fit, a talus of fewer than kLeastThreshold units, bedrock that does not match or lies above the surface.
[[nodiscard]] GridSand toSand(const EsriGrid& surface, const EsriGrid* bedrock, const TalusSettings& material);

}  // namespace scene::relax
