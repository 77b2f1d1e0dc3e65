// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/input_error.hpp"
#include "scene/relax/tin_sand.hpp"

namespace scene::relax {
namespace {

constexpr double kMostOblongCell = 1000;      // longer side / shorter side
constexpr double kLatticeSide = 524288;       // [lattice step], 2^19: a field's side comes close to it
constexpr double kMostLatticeSide = 4194304;  // 2^22: largest side that a mesh can have
constexpr std::int32_t kLeastSpacing = 4, kMostSpacing = 4096;

/// Returns the lattice steps on a cell's sides. The shorter side has a power of two.
sand::tin::LatticePoint spacingOf(const EsriGrid& raster) {
    const double ratio = std::max(raster.aspect(), 1 / raster.aspect());
    if (!(ratio <= kMostOblongCell)) {
        throw base::InputError(fmt::format("{}: cells of {} x {} are too oblong; sides must be within 1 : {}",
                                           raster.file, raster.cellSize, raster.cellDepth.value_or(raster.cellSize),
                                           kMostOblongCell));
    }
    const bool wide = raster.aspect() < 1;
    const double longest = std::max(raster.columns * (wide ? ratio : 1.0), raster.rows * (wide ? 1.0 : ratio));
    std::int32_t shorter = kMostSpacing;
    while (shorter > kLeastSpacing && shorter * longest > kLatticeSide) {
        shorter /= 2;
    }
    if (shorter * longest > kMostLatticeSide) {
        throw base::InputError(fmt::format("{}: {} x {} cells are too many for a TIN; make them coarser: gdalwarp -tr",
                                           raster.file, raster.columns, raster.rows));
    }
    const auto longer = static_cast<std::int32_t>(std::floor(shorter * ratio + 0.5));
    return wide ? sand::tin::LatticePoint{longer, shorter} : sand::tin::LatticePoint{shorter, longer};
}

}  // namespace

Thinned thin(EsriGrid raster, const sand::tin::SimplifyGoal& goal) {
    if (std::min(raster.columns, raster.rows) < 2) {
        throw base::InputError(fmt::format("{}: {} x {} cells with data have no area between their middles",
                                           raster.file, raster.columns, raster.rows));
    }
    const sand::tin::LatticePoint spacing = spacingOf(raster);
    std::vector<double> heights;
    heights.reserve(raster.heights.size());
    for (int row = 0; row < raster.rows; ++row) {
        for (int column = 0; column < raster.columns; ++column) {
            if (raster.isNoData(column, row) && raster.aspect() != 1) {
                raster.fail(column, row,
                            fmt::format("no data inside a raster of cells of {} x {}; a TIN with holes takes square "
                                        "ones: gdalwarp -tr",
                                        raster.cellSize, *raster.cellDepth));
            }
            heights.push_back(raster.at(column, row));
        }
    }
    raster.heights = {};  // frees memory before the TIN takes some
    // The TIN reaches from middle to middle. Beyond, the ground would be a strip whose only vertices are the corners,
    // and would end in a cliff.
    const sand::tin::Raster samples{heights, raster.columns, raster.rows, {0, 0}, spacing};
    const sand::tin::Cells cells{.columns = raster.columns,
                                 .rows = raster.rows,
                                 .first = {},
                                 .spacing = spacing,
                                 .width = spacing.x * (raster.columns - 1),
                                 .depth = spacing.y * (raster.rows - 1)};
    const auto holes = sand::tin::holesOf(heights, cells);
    const sand::tin::Border border = sand::tin::borderOf(heights, cells, holes.get(), goal.maxError,
                                                         {.onOutline = sand::tin::usualOnOutline(cells)});
    if (border.places.size() + 4 > static_cast<std::size_t>(goal.maxVertices)) {
        throw base::InputError(
            fmt::format("{}: the outline of its cells without data takes {} vertices, and {} are the "
                        "most; give more, or a larger --max-error",
                        raster.file, border.places.size() + 4, goal.maxVertices));
    }
    const sand::tin::Simplified chosen = sand::tin::simplify(cells.width, cells.depth, samples, goal, border);
    Thinned thinned{{}, raster.cellSize / spacing.x, chosen.maxError, chosen.rmsError, holes, border.edges};
    for (std::size_t i = 0; i < chosen.places.size(); ++i) {
        const double column = static_cast<double>(chosen.places[i].x) / spacing.x + 0.5;
        const double row = static_cast<double>(chosen.places[i].y) / spacing.y + 0.5;
        thinned.points.push_back({raster.westEdge + column * raster.cellSize,
                                  raster.southEdge + row * raster.cellDepth.value_or(raster.cellSize),
                                  chosen.heights[i]});
    }
    return thinned;
}

}  // namespace scene::relax
