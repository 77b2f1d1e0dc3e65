// SPDX-License-Identifier: Apache-2.0
#include "scene/import/degrees.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <optional>

#include "base/input_error.hpp"
#include "scene/import/metric_system.hpp"
#include "scene/import/no_data.hpp"

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
    // A number that usually means no data makes steep slopes around it, whatever the lengths are.
    const auto heightAt = [&](int column, int row) {
        const double height = grid.at(column, row);
        return isUsualNoData(height * grid.units.heightsPerLength) ? std::nan("") : height;
    };
    Slopes slopes;
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            const double here = heightAt(column, row);
            if (column + 1 < grid.columns) {
                slopes.add(heightAt(column + 1, row) - here, grid.cellSize);
            }
            if (row + 1 < grid.rows) {
                slopes.add(heightAt(column, row + 1) - here, depth);
            }
        }
    }
    return slopes.mostAreSteep();
}

/// Returns why the lengths seem to be degrees, or nullopt.
std::optional<std::string> whyDegrees(const EsriGrid& grid) {
    const double depth = grid.cellDepth.value_or(grid.cellSize);
    const double east = grid.westEdge + grid.columns * grid.cellSize;
    const double north = grid.southEdge + grid.rows * depth;
    // Some data count longitudes from 0 to 360.
    // A grid whose outer cells have their middles on the date line or a pole reaches half a cell beyond. The rest is
    // for rounded corners and cell sizes.
    constexpr double kSlack = 0.51;
    const double beyond = kSlack * grid.cellSize, beyondPole = kSlack * depth;
    const bool onGlobe = grid.westEdge >= -180 - beyond && east <= 360 + beyond && grid.southEdge >= -90 - beyondPole &&
                         north <= 90 + beyondPole;
    if (!grid.units.crs.empty() || !onGlobe || !mostSlopesAreSteep(grid)) {
        return std::nullopt;
    }
    return fmt::format(
        "{}: its lengths seem to be degrees: from the corner ({}, {}) on, cells of {} would make most slopes steeper "
        "than 80 degrees; make metres of them: {}",
        grid.file, grid.westEdge, grid.southEdge, grid.cellSize,
        warpCommand(grid.file, (grid.westEdge + east) / 2, (grid.southEdge + north) / 2, "-s_srs EPSG:4326 "));
}

}  // namespace

void requireLengths(const EsriGrid& grid, const std::string& otherwise) {
    if (const std::optional<std::string> why = whyDegrees(grid)) {
        throw base::InputError(*why + otherwise);
    }
}

}  // namespace scene
