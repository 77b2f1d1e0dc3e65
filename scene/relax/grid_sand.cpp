// SPDX-License-Identifier: Apache-2.0
#include "scene/relax/grid_sand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/input_error.hpp"
#include "scene/import/rock_fit.hpp"

namespace scene::relax {
namespace {

constexpr double kMostOblong = 1000;                // longer side / shorter side of a cell
constexpr double kFineThreshold = 4096;             // [unit]; from it on, slopes rest within a percent of the talus
constexpr double kLargestThreshold = 1073741824.0;  // [unit]; no difference between heights is larger

/// A height of a grid, with its position.
struct Cell {
    const EsriGrid* grid = nullptr;
    int column = 0, row = 0;
    [[nodiscard]] double height() const { return grid->at(column, row); }
};

struct Extremes {
    Cell lowest, highest;
};

/// Adds the heights of a grid in cells in which `surface` has data.
void include(const EsriGrid& grid, const EsriGrid& surface, Extremes& extremes) {
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            const Cell cell{&grid, column, row};
            if (grid.isNoData(column, row) || surface.isNoData(column, row)) {
                continue;
            }
            if (extremes.lowest.grid == nullptr || cell.height() < extremes.lowest.height()) {
                extremes.lowest = cell;
            }
            if (extremes.highest.grid == nullptr || cell.height() > extremes.highest.height()) {
                extremes.highest = cell;
            }
        }
    }
}

HeightScale scaleFor(const EsriGrid& surface, const Extremes& extremes) {
    const double shorter = surface.cellSize * std::min(1.0, surface.aspect());
    const double lowest = extremes.lowest.height();
    const double highest = extremes.highest.height();
    const HeightScale scale = HeightScale::finest(shorter, lowest, highest);
    if (scale.bits < 0) {
        const Cell& odd = std::abs(lowest) > std::abs(highest) ? extremes.lowest : extremes.highest;
        odd.grid->fail(odd.column, odd.row,
                       fmt::format("a height of {} is out of range: heights may span at most {:.4g} (2^29 cells), and "
                                   "here they lie between {} and {}",
                                   odd.height(), 2.0 * sand::kMaxHeight * shorter, lowest, highest));
    }
    return scale;
}

/// Returns the share by which faces across one axis may rest too steep, because a flux is rounded down to whole units.
///
/// Let a be the difference across a face, b the slope along it, t the threshold and t + x the slope, all in units of
/// height. Near the threshold the flux is k a x / t, so that the face rests while a < t / (k x). The faces beside it,
/// whose mean is b, rest near t, so that x is about a² / (2 t). Both together give x³ < t / (2 k²). If the slope runs
/// across the face, a is t, and x < 1 / k.
double steepening(double threshold, double k) { return (std::cbrt(threshold / (2 * k * k)) + 1 / k) / threshold; }

/// Returns the share of the axis with the larger one. k is twice the push of sand/grid/erosion.cpp, or its limit
/// without inertia.
double steepeningOfGrid(double threshold, double aspect, sand::Scheme scheme) {
    const auto k = [scheme](double ratio) {
        const double squared = ratio * ratio;
        return scheme == sand::Scheme::isotropic ? 0.45 * std::min(1.0, 1 / squared) : 0.4998 / (squared + 1);
    };
    return std::max(steepening(threshold, k(1 / aspect)), steepening(threshold * aspect, k(aspect)));
}

void setTalus(const EsriGrid& surface, const Extremes& extremes, const TalusSettings& material, GridSand& sand) {
    const double aspect = surface.aspect();
    const double slope = std::tan(material.talusDegrees * std::numbers::pi / 180);
    const double threshold = std::min(std::floor(slope * surface.cellSize / sand.scale.unit + 0.5), kLargestThreshold);
    sand.rules.tuning.threshold = static_cast<std::int32_t>(threshold);
    sand.rules.tuning.startThreshold =
        static_cast<std::int32_t>(std::min(std::floor(threshold * (1 + material.band)), kLargestThreshold));
    const double least = std::floor(threshold * std::min(1.0, aspect));
    const std::string units = fmt::format("{}: a talus of {} degrees is {} height units of {:.4g} from cell to cell",
                                          surface.file, material.talusDegrees, least, sand.scale.unit);
    // Coarse units come from heights that are far apart, and seldom from another cause.
    const std::string span =
        sand.scale.bits == sand::kHeightBits
            ? ""
            : fmt::format("; heights from {} to {} span {:.4g} cells: if some are not terrain, make them no-data",
                          extremes.lowest.height(), extremes.highest.height(),
                          (extremes.highest.height() - extremes.lowest.height()) / surface.cellSize);
    const bool level = material.talusDegrees == 0;
    if (least < kLeastThreshold && !level) {
        throw base::InputError(
            fmt::format("{}, and {} is the least, except for 0 degrees{}", units, kLeastThreshold, span));
    }
    const double tooSteep = level ? 0 : steepeningOfGrid(threshold, aspect, sand.rules.scheme);
    if (tooSteep > steepeningOfGrid(kFineThreshold, 1, sand.rules.scheme)) {
        sand.warnings.push_back(
            fmt::format("{}: slopes may come to rest {:.2g} % too steep{}", units, 100 * tooSteep, span));
    }
}

/// Returns the height of the rock in a cell of the grids [unit], which is at most that of the surface.
std::int32_t rockUnder(const EsriGrid& bedrock, const EsriGrid& surface, int column, int row,
                       const HeightScale& scale) {
    const double height = surface.at(column, row);
    if (bedrock.isNoData(column, row)) {
        bedrock.fail(column, row, fmt::format("no rock under {}'s height of {}", surface.file, height));
    }
    const double rock = bedrock.at(column, row);
    // Two files that mean the same height may differ in their last digit.
    if (rock - height >= scale.unit) {
        bedrock.fail(column, row,
                     fmt::format("rock at {} lies above {}'s height of {}; rock must not be higher", rock, surface.file,
                                 height));
    }
    return std::min(scale.toUnits(rock), scale.toUnits(height));
}

void fill(const EsriGrid& surface, const EsriGrid* bedrock, GridSand& sand) {
    const auto ground = [&]() -> sand::Ground& {
        return sand.ground ? *sand.ground : sand.ground.emplace(sand.field.columns(), sand.field.rows());
    };
    sand.lowest = sand::kMaxHeight;
    for (int y = 0; y < sand.field.rows(); ++y) {
        for (int x = 0; x < sand.field.columns(); ++x) {
            const int column = sand.cells.x0 + x;
            const int row = sand.cells.y0 + y;
            if (surface.isNoData(column, row)) {
                ground().setWall(x, y);
                continue;
            }
            const std::int32_t units = sand.scale.toUnits(surface.at(column, row));
            sand.field.setHeight(x, y, units);
            sand.lowest = std::min(sand.lowest, units);
            if (bedrock != nullptr) {
                ground().setBedrock(x, y, rockUnder(*bedrock, surface, column, row, sand.scale));
            }
        }
    }
}

}  // namespace

GridSand toSand(const EsriGrid& surface, const EsriGrid* bedrock, const TalusSettings& material) {
    const double aspect = surface.aspect();
    if (!(std::max(aspect, 1 / aspect) <= kMostOblong)) {
        throw base::InputError(fmt::format("{}: cells of {} x {} are too oblong; sides must be within 1 : {}",
                                           surface.file, surface.cellSize, *surface.cellDepth, kMostOblong));
    }
    const sand::CellRect cells = cellsWithData(surface);
    if (cells.empty()) {
        throw base::InputError(surface.file + ": every cell is a no-data cell; the grid holds no sand");
    }
    if (bedrock != nullptr) {
        requireSameCells(surface, *bedrock);
    }
    Extremes extremes;
    include(surface, surface, extremes);
    if (bedrock != nullptr) {
        include(*bedrock, surface, extremes);
    }
    const HeightScale scale = scaleFor(surface, extremes);
    // A field's unit is its cell divided by 2^16. The cell of the file is not needed, because no length of the scene is
    // used.
    GridSand sand{
        .cells = cells,
        .field = sand::HeightField(cells.x1 - cells.x0, cells.y1 - cells.y0, scale.unit * sand::kUnitsPerCell),
        .ground = std::nullopt,
        .rules = {},
        .scale = scale,
        .onBedrock = bedrock != nullptr,
        .lowest = 0,
        .warnings = {}};
    sand.rules.columns = sand.field.columns();
    sand.rules.rows = sand.field.rows();
    sand.rules.aspect = static_cast<std::int32_t>(std::floor(aspect * sand::kUnitsPerCell + 0.5));
    sand.rules.scheme = material.scheme;
    setTalus(surface, extremes, material, sand);
    fill(surface, bedrock, sand);
    return sand;
}

std::int64_t GridSand::volume() const {
    std::int64_t sum = 0;
    for (int row = 0; row < field.rows(); ++row) {
        for (int column = 0; column < field.columns(); ++column) {
            if (!isWall(column, row)) {
                sum += field.height(column, row) - (onBedrock ? ground->bedrock(column, row) : lowest);
            }
        }
    }
    return sum;
}

EsriGrid GridSand::toGrid(const EsriGrid& before) const {
    std::vector<double> heights(before.heights.begin(), before.heights.end());
    for (int y = 0; y < field.rows(); ++y) {
        for (int x = 0; x < field.columns(); ++x) {
            double& height = heights[before.index(cells.x0 + x, cells.y0 + y)];
            const std::int32_t units = field.height(x, y);
            if (isWall(x, y) || units == scale.toUnits(height)) {
                continue;
            }
            height = withFewDecimals(scale.toHeight(units), scale.unit);
            if (height == before.noData) {
                height += scale.unit / 64;  // otherwise the height would count as no data
            }
        }
    }
    EsriGrid result = withoutHeights(before);
    result.heights = std::move(heights);
    result.noData = before.noData;
    return result;
}

}  // namespace scene::relax
