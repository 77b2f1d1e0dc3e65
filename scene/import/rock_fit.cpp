// SPDX-License-Identifier: Apache-2.0
#include "scene/import/rock_fit.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/input_error.hpp"
#include "scene/import/importer.hpp"
#include "scene/import/raster_units.hpp"

namespace scene {
namespace {

std::string cellsOf(const EsriGrid& grid) {
    return fmt::format("{}: {} x {} cells of {} x {} from ({}, {})", grid.file, grid.columns, grid.rows, grid.cellSize,
                       grid.cellDepth.value_or(grid.cellSize), grid.westEdge, grid.southEdge);
}

/// Other programs may have printed the same corner with other digits.
bool sameCells(const EsriGrid& a, const EsriGrid& b) {
    const auto near = [](double x, double y, double tolerance) { return std::abs(x - y) <= tolerance; };
    return a.columns == b.columns && a.rows == b.rows && near(a.cellSize, b.cellSize, 1e-6 * a.cellSize) &&
           near(a.aspect(), b.aspect(), 1e-6 * a.aspect()) && near(a.westEdge, b.westEdge, 1e-3 * a.cellSize) &&
           near(a.southEdge, b.southEdge, 1e-3 * a.cellSize * a.aspect());
}

}  // namespace

EsriGrid withoutHeights(const EsriGrid& grid) {
    EsriGrid result;
    result.columns = grid.columns;
    result.rows = grid.rows;
    result.cellSize = grid.cellSize;
    result.cellDepth = grid.cellDepth;
    result.westEdge = grid.westEdge;
    result.southEdge = grid.southEdge;
    result.file = grid.file;
    result.units = grid.units;
    result.origins = grid.origins;
    return result;
}

void requireSameCells(const EsriGrid& sand, const EsriGrid& rock) {
    if (!sameCells(sand, rock)) {
        throw base::InputError(fmt::format(
            "{}, but {}: they must be the same; resample the rock: gdalwarp -te {} {} {} {} -ts {} {} -r bilinear",
            cellsOf(rock), cellsOf(sand), sand.westEdge, sand.southEdge, sand.westEdge + sand.columns * sand.cellSize,
            sand.southEdge + sand.rows * sand.cellDepth.value_or(sand.cellSize), sand.columns, sand.rows));
    }
}

void requireSameSystem(const EsriGrid& sand, const EsriGrid& rock) {
    const std::string &above = sand.units.crs, &below = rock.units.crs;
    if (above.empty() || below.empty() || above == below ||
        loadImporter(rock.file).sameSystem(above, below, rock.file)) {
        return;
    }
    throw base::InputError(fmt::format(
        "{}: the rock's coordinate system is {}, and that of the sand {} is {}; warp the rock to the sand's "
        "with gdalwarp -t_srs",
        rock.file, rock.origins.across, sand.file, sand.origins.across));
}

void requireFit(const EsriGrid& sand, const EsriGrid& rock) {
    requireSameUnits(sand, rock);
    requireSameSystem(sand, rock);
    requireSameCells(sand, rock);
}

}  // namespace scene
