// SPDX-License-Identifier: Apache-2.0
#include "scene/load/tin_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sand/model/step.hpp"
#include "sand/model/tool_shape.hpp"
#include "sand/tin/geometry/lattice.hpp"

namespace scene {
namespace {

constexpr int kCorners = 4;
constexpr int kMostToGive = 1 << 22;
constexpr int kUsual = sand::tin::Settings{}.mostVertices;

sand::tin::Settings readNumbers(const host::TomlTable& tin, double cellSize) {
    sand::tin::Settings settings;
    const double finest = sand::probeUnit(cellSize);
    const double spacing = tin.numberOr("spacing", cellSize, {finest, 1e9});
    settings.spacing = static_cast<std::int32_t>(std::min(std::floor(spacing / finest + 0.5), double{sand::kMaxProbe}));
    const double widest = tin.numberOr("widest", 16 * cellSize, {0, 1e9});
    settings.widest = static_cast<std::int32_t>(std::min(std::floor(widest / finest + 0.5), double{sand::kMaxProbe}));
    const double error = tin.numberOr("max_error", cellSize / 16, {0, 1e9});
    settings.maxError = static_cast<std::int32_t>(
        std::min(std::floor(error / cellSize * sand::kUnitsPerCell + 0.5), static_cast<double>(sand::kMaxHeight)));
    settings.mostVertices = tin.integerOr("vertices", settings.mostVertices, kCorners, kMostToGive);
    settings.keepConstraints = tin.flagOr("keep_constraints", settings.keepConstraints);
    return settings;
}

std::int64_t latticeSize(const TinCells& cells, std::int32_t widest) {
    return sand::tin::Lattice(widest).size(cells.columns, cells.rows);
}

/// Returns `widest`, or the smallest distance above it at which there are at most `most` vertices. Returns 0 if one
/// vertex is too many.
std::int32_t widened(const TinCells& cells, std::int32_t widest, std::int64_t most) {
    const std::int32_t longer = std::max(cells.columns, cells.rows) * sand::kProbePerCell;
    while (latticeSize(cells, widest) > most) {
        if (widest > longer) {
            return 0;
        }
        widest += sand::kProbePerCell;
    }
    return widest;
}

}  // namespace

sand::tin::Settings readTinSettings(const host::TomlTable& tin, const TinCells& cells) {
    sand::tin::Settings settings = readNumbers(tin, cells.side);
    if (!tin.has("widest")) {
        // Half of the vertices, because otherwise none would be left for terrain and tool.
        settings.widest = widened(cells, settings.widest, (settings.mostVertices - kCorners) / 2);
        return settings;
    }
    const int most = tin.has("vertices") ? settings.mostVertices : kMostToGive;
    const std::int64_t wanted = latticeSize(cells, settings.widest) + kCorners;
    if (wanted > most) {
        const std::int32_t least = widened(cells, settings.widest, most - kCorners);
        tin.fail(
            "widest",
            fmt::format("points {} apart on {} x {} cells are {} vertices, and {} are the most; widest "
                        "must be {}",
                        tin.number("widest"), cells.columns, cells.rows, wanted, most,
                        least == 0 ? "0 (none)" : fmt::format("at least {:.9g}", least * sand::probeUnit(cells.side))));
    }
    if (!tin.has("vertices")) {
        settings.mostVertices = static_cast<std::int32_t>(std::min<std::int64_t>(wanted + kUsual, most));
    }
    return settings;
}

sand::tin::Settings readTinSettings(const host::TomlTable& tin, const TinCells& cells, std::size_t places) {
    sand::tin::Settings settings = readNumbers(tin, cells.side);
    if (tin.has("vertices") && places > static_cast<std::size_t>(settings.mostVertices)) {
        tin.fail("vertices",
                 fmt::format("the points are {} vertices with the field's corners, and {} are the most; raise it, or "
                             "thin out the points",
                             places, settings.mostVertices));
    }
    return settings;
}

void keepUsual(const host::TomlTable& tin, sand::tin::TinStart& start) {
    if (!tin.has("vertices")) {
        start.settings.mostVertices = std::max(kUsual, static_cast<std::int32_t>(start.places.size()));
    }
}

void requireSpacing(const host::TomlTable& file, const Scene& scene) {
    if (scene.tin == nullptr) {
        return;
    }
    const sand::tin::Settings& settings = scene.tin->settings;
    const sand::CellRect reach =
        sand::TurnedShape(scene.rules.tuning.tool).cellsChanged(0, 0);  // along the tool's length
    const double width = std::min(reach.x1 - reach.x0, scene.rules.columns) * double{sand::kProbePerCell};
    const double depth = std::min(reach.x1 - reach.x0, scene.rules.rows) * double{sand::kProbePerCell};
    const double least =
        std::min(std::ceil(std::sqrt(width * depth / settings.mostVertices)), double{sand::kProbePerCell});
    if (settings.spacing < least) {
        const double finest = sand::probeUnit(scene.terrain.cellSize());
        const host::TomlTable tin = file.requiredTable("tin");
        tin.fail("spacing",
                 fmt::format("points {} apart would be {:.0f} where a tool of radius {} works, and {} are the "
                             "most; spacing must be at least {:.9g}",
                             tin.number("spacing"), width * depth / settings.spacing / settings.spacing,
                             scene.material.toolRadius, settings.mostVertices, least * finest));
    }
}

}  // namespace scene
