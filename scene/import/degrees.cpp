// SPDX-License-Identifier: Apache-2.0
#include "scene/import/degrees.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>

#include "scene/import/metric_system.hpp"

namespace scene {
namespace {

constexpr double kSteep = 5.671281819617709;  // tangent of 80 degrees

/// Counts all slopes from cell to cell, and the slopes that are steeper than kSteep.
class Slopes {
public:
    void add(double rise, double run) {
        if (!std::isnan(rise)) {  // it is not a number beside a cell without data
            ++all_;
            steep_ += std::abs(rise) > kSteep * run ? 1 : 0;
        }
    }
    /// Returns whether the median slope is steep. The median needs no sorting, because only its side is asked for.
    [[nodiscard]] bool mostAreSteep() const { return 2 * steep_ > all_; }

private:
    std::int64_t all_ = 0, steep_ = 0;
};

bool mostSlopesAreSteep(const EsriGrid& grid) {
    const double depth = grid.cellDepth.value_or(grid.cellSize);
    Slopes slopes;
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            const double here = grid.at(column, row);
            if (column + 1 < grid.columns) {
                slopes.add(grid.at(column + 1, row) - here, grid.cellSize);
            }
            if (row + 1 < grid.rows) {
                slopes.add(grid.at(column, row + 1) - here, depth);
            }
        }
    }
    return slopes.mostAreSteep();
}

}  // namespace

std::optional<std::string> whyDegrees(const EsriGrid& grid) {
    const double east = grid.westEdge + grid.columns * grid.cellSize;
    const double north = grid.southEdge + grid.rows * grid.cellDepth.value_or(grid.cellSize);
    const bool onGlobe = grid.westEdge >= -180 && east <= 180 && grid.southEdge >= -90 && north <= 90;
    if (!grid.units.crs.empty() || !onGlobe || !mostSlopesAreSteep(grid)) {
        return std::nullopt;
    }
    const int epsg = metricSystemAt((grid.westEdge + east) / 2, (grid.southEdge + north) / 2);
    return fmt::format(
        "{}: its lengths seem to be degrees: from the corner ({}, {}) on, cells of {} would make most slopes steeper "
        "than 80 degrees; make metres of them: gdalwarp -s_srs EPSG:4326 -t_srs EPSG:{} -r bilinear {} metres.tif",
        grid.file, grid.westEdge, grid.southEdge, grid.cellSize, epsg,
        std::filesystem::path(grid.file).filename().string());
}

}  // namespace scene
