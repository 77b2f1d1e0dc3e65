// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "scene/import/esri_grid.hpp"
#include "scene/model/scene.hpp"
#include "scene/relax/height_scale.hpp"

namespace scene::relax {

inline constexpr int kLeastThreshold = 4;  // [unit]; a coarser talus is no longer an angle

/// Talus and scheme from the command line.
struct TalusSettings {
    double talusDegrees = 0;  // [degree], in [0, 90)
    double band = 0;          // share beyond the talus at which sand at rest starts to slide
    sand::Scheme scheme = sand::Scheme::isotropic;
};

/// Grid from a file as sand, with the scale of its whole numbers. Edges without data are left out, so that the rim of
/// the sand is where data ends.
struct GridSand {
    sand::CellRect cells;                // cells of the grid that are in the field
    sand::HeightField field;             // walls have height 0
    std::optional<sand::Ground> ground;  // nullopt without bedrock and without a cell without data, which is a wall
    sand::Rules rules;                   // with a closed rim
    HeightScale scale;
    bool onBedrock = false;
    std::int32_t lowest = 0;  // lowest surface at the start [unit]; without bedrock, volumes are counted from it
    std::vector<std::string> warnings;  // one line each

    [[nodiscard]] bool isWall(int column, int row) const { return ground && ground->isWall(column, row); }
    /// Returns the volume of the sand above the bedrock, or above the lowest cell of the start [unit · cell].
    [[nodiscard]] std::int64_t volume() const;
    /// Returns the original grid with the current heights. Cells that have not changed keep their heights exactly.
    [[nodiscard]] EsriGrid toGrid(const EsriGrid& before) const;
};

/// Makes sand of a grid. Throws base::InputError with file, line, value and range for:
/// - a grid without any data, cells more oblong than 1 to 1000, heights that do not fit,
/// - a talus of fewer than kLeastThreshold units,
/// - bedrock that does not match or is above the surface.
[[nodiscard]] GridSand toSand(const EsriGrid& surface, const EsriGrid* bedrock, const TalusSettings& material);

}  // namespace scene::relax
