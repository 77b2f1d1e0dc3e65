// SPDX-License-Identifier: Apache-2.0
#include "web/hand/grid_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "base/input_error.hpp"
#include "base/text_reader.hpp"
#include "scene/import/degrees.hpp"
#include "scene/import/esri_grid.hpp"
#include "scene/import/grid_terrain.hpp"
#include "web/replica/opening.hpp"

namespace web {
namespace {

constexpr int kStepsPerSecond = 60;  // of scenes, unless they say otherwise

/// Returns a check of the size of a grid whose text has `bytes` bytes. The reader copies the text.
scene::RasterCheck fits(const std::string& name, std::int64_t bytes, std::int64_t memory) {
    return [name, bytes, memory](const scene::RasterSize& size) {
        requireMemory(name, {size.columns, size.rows, false}, memory, size.bytes() + 2 * bytes);
    };
}

/// Returns the height that is 0 in the scene [length unit]: the middle of all heights as a multiple of `unit`. So
/// heights keep their exact distances.
double datumOf(const scene::EsriGrid& grid, double unit) {
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (const double height : grid.heights) {
        lowest = height < lowest ? height : lowest;  // a NaN is neither
        highest = height > highest ? height : highest;
    }
    const double most = 2.0 * sand::kMaxHeight * unit;
    if (!(highest - lowest < most)) {
        throw base::InputError(
            fmt::format("{}: heights from {} to {} span more than {:.4g} (8192 cells); make those that are no terrain "
                        "no-data, or check the unit of the heights",
                        grid.file, lowest, highest, most));
    }
    return unit * std::floor((lowest / 2 + highest / 2) / unit + 0.5);
}

std::string stemOf(const std::string& name) { return name.substr(0, name.rfind('.')); }

}  // namespace

void requireGridFits(std::string_view begin, std::int64_t bytes, const std::string& name, std::int64_t memory) {
    base::TextReader reader(begin, name);
    scene::checkEsriHeader(reader, fits(name, bytes, memory));
}

scene::Scene sceneOfGrid(std::string_view text, const std::string& name, std::int64_t memory) {
    base::TextReader reader(text, name);
    scene::EsriGrid whole =
        scene::readEsriText(reader, fits(name, static_cast<std::int64_t>(text.size()), memory), text.size() / 2 + 1);
    scene::requireLengths(whole, "");
    if (whole.aspect() != 1) {
        throw base::InputError(
            fmt::format("{0}: has cells of {1} x {2}; a page's are square: resample it with gdalwarp "
                        "-tr {1} {1} -r bilinear",
                        name, whole.cellSize, *whole.cellDepth));
    }
    const scene::EsriGrid grid = scene::withoutEmptyEdges(std::move(whole));
    scene::Scene scene;
    scene.name = stemOf(name);
    scene.warnings = grid.warnings;
    scene.rules.columns = grid.columns;
    scene.rules.rows = grid.rows;
    scene.rules.stepsPerSecond = kStepsPerSecond;
    scene.terrain = sand::HeightField(grid.columns, grid.rows, grid.cellSize);
    const double datum = datumOf(grid, scene.terrain.unit());
    scene.georeference.west = grid.westEdge;
    scene.georeference.south = grid.southEdge;
    scene.georeference.datum = datum;
    const auto unitsOf = [datum, unit = scene.terrain.unit()](double height) {
        return static_cast<std::int32_t>(std::floor((height - datum) / unit + 0.5));
    };
    std::shared_ptr<sand::Ground> ground;
    scene::layTerrain(grid, unitsOf, scene.terrain, ground);
    scene.ground = ground;
    scene.rules.ground = ground == nullptr ? 0 : ground->digest();
    scene.material.toolRadius = scene::usualToolRadius(grid.columns, grid.rows, grid.cellSize);
    if (const auto fault = scene::faultOf(scene.material, scene.grid())) {
        throw base::InputError(fmt::format("{}: {}", name, fault->message));
    }
    scene.rules.tuning = scene::tuningOf(scene.material, scene.grid());
    scene.force.unitLength = std::max(grid.columns, grid.rows) * grid.cellSize;
    return scene;
}

}  // namespace web
