// SPDX-License-Identifier: Apache-2.0
#include "scene/load/terrain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

#include "sand/grid/dunes.hpp"
#include "scene/import/degrees.hpp"
#include "scene/import/grid_terrain.hpp"
#include "scene/import/no_data.hpp"
#include "scene/import/raster_file.hpp"
#include "scene/import/raster_units.hpp"
#include "scene/import/rock_fit.hpp"
#include "scene/load/progress.hpp"
#include "scene/load/terrain_source.hpp"
#include "scene/load/tin_table.hpp"

namespace scene {
namespace {

// Parts of the time of reading.
constexpr double kPixels = 0.6;  // pixels of a raster; making heights of them takes the rest
constexpr double kAbove = 0.6;   // the sand, if there is rock in another file

sand::HeightField levelField(const host::TomlTable& file, const SizeChecks& checks) {
    const host::TomlTable field = file.requiredTable("field");
    const int columns = field.integerOr("columns", 512, 1, sand::kMaxSide);
    const int rows = field.integerOr("rows", columns, 1, sand::kMaxSide);
    const double width = field.numberOr("width", 2.0, host::kPositive);  // (-1, 1) as in Dorjgotov et al. 2007
    field.finish();
    if (checks.field) {
        const host::TomlTable terrain = file.requiredTable("terrain");
        checks.field({{columns, rows, file.has("tin")},
                      terrain.has("layer") || terrain.has("bedrock"),
                      terrain.flagOr("settle", false)});
    }
    return {columns, rows, width / columns};
}

std::int32_t heightUnits(const host::TomlTable& terrain, const std::string& key, double height, double unit,
                         const char* advice = "set 'datum'") {
    const double units = std::floor(height / unit + 0.5);
    if (!(std::abs(units) <= sand::kMaxHeight)) {
        terrain.fail(key, fmt::format("a height of {} is beyond the range of ±{} (4096 cells); {}", height,
                                      sand::kMaxHeight * unit, advice));
    }
    return static_cast<std::int32_t>(units);
}

/// Returns the ground of a scene; creates it at the first call.
sand::Ground& groundOf(std::shared_ptr<sand::Ground>& ground, const sand::HeightField& field) {
    if (ground == nullptr) {
        ground = std::make_shared<sand::Ground>(field.columns(), field.rows());
    }
    return *ground;
}

/// Throws base::InputError unless cells are square. `kind` is that of the terrain: GDAL has no driver for Gwyddion's
/// files.
void requireSquareCells(const host::TomlTable& terrain, std::string_view kind, const EsriGrid& raster) {
    if (raster.aspect() != 1) {
        const std::string advice = kind == "gsf" ? " in Gwyddion: Data Process > Basic Operations > Resample"
                                                 : fmt::format(": gdalwarp -tr {0} {0} -r bilinear", raster.cellSize);
        terrain.fail("file", fmt::format("{} has cells of {} x {}; a scene's are square; resample it{}", raster.file,
                                         raster.cellSize, *raster.cellDepth, advice));
    }
}

/// Checks the size of a field before its heights are read or computed.
class AskedBeforeHeights {
public:
    AskedBeforeHeights(const host::TomlTable& file, const host::TomlTable& terrain, const SizeChecks& checks)
        : terrain_(terrain), checks_(checks), computed_(file.has("field")), tin_(file.has("tin")) {}

    /// Called with the size of the source.
    void operator()(const RasterSize& size) {
        if (size.columns > sand::kMaxSide || size.rows > sand::kMaxSide) {
            terrain_.fail("file", fmt::format("{} has {} x {} cells; a scene's are at most {} a side",
                                              (terrain_.folder() / terrain_.text("file")).string(), size.columns,
                                              size.rows, sand::kMaxSide));
        }
        if (checks_.raster && !computed_) {
            checks_.raster(size);
        }
        // A grid of rock has the same cells, so that no edge without data is cut off.
        if (size.complete || terrain_.has("bedrock")) {
            askOfField(size.columns, size.rows, !size.complete);
        } else if (checks_.fieldAtMost) {
            checks_.fieldAtMost(sizeOf(size.columns, size.rows, false));
        }
    }
    /// Called with the size of the field. Returns at once if the size was checked before.
    void askOfField(int columns, int rows, bool walls) {
        if (checks_.field && !std::exchange(asked_, true)) {
            checks_.field(sizeOf(columns, rows, walls));
        }
    }

private:
    [[nodiscard]] FieldToMake sizeOf(int columns, int rows, bool walls) const {
        return {{columns, rows, tin_},
                walls || terrain_.has("layer") || terrain_.has("bedrock"),
                terrain_.flagOr("settle", false)};
    }

    const host::TomlTable& terrain_;
    const SizeChecks& checks_;
    bool computed_, tin_;
    bool asked_ = false;
};

/// Returns the field of a source, whose cells without data become walls. Sets `survey` to the raster without heights if
/// it is on a map.
sand::HeightField fromSource(const host::TomlTable& file, const host::TomlTable& terrain, int kind, Scene& scene,
                             std::optional<EsriGrid>& survey, std::shared_ptr<sand::Ground>& ground,
                             const SizeChecks& checks) {
    AskedBeforeHeights asked(file, terrain, checks);
    TerrainSource source =
        readSource(file, terrain, kind, RasterCheck(std::ref(asked), partOf(checks.progress, 0, kPixels)));
    scene.warnings.insert(scene.warnings.end(), source.warnings.begin(), source.warnings.end());
    if (source.statement) {
        scene.statements->push_back(*source.statement);
    }
    if (!source.points.empty()) {
        if (!file.has("tin")) {
            terrain.fail("kind",
                         "points make a triangulated terrain: add [tin]; or make a raster of them, for kind = "
                         "\"dem\": gdal_grid");
        }
        return layOutPoints(file, terrain, source.points, scene);
    }
    if (source.onMap && !terrain.flagOr("lengths", false)) {
        requireLengths(source.raster, "; or insist on lengths with lengths = true");
    }
    requireSquareCells(terrain, sourceKinds().at(static_cast<std::size_t>(kind)), source.raster);
    // A grid of rock has the same cells, including those at the edges.
    const EsriGrid grid =
        terrain.has("bedrock") ? std::move(source.raster) : withoutEmptyEdges(std::move(source.raster));
    scene.georeference = source.referenceAt(grid);
    const double datum = scene.georeference.datum;
    if (source.onMap) {
        survey = withoutHeights(grid);
    }
    const bool walls =
        std::any_of(grid.heights.begin(), grid.heights.end(), [](double height) { return std::isnan(height); });
    asked.askOfField(grid.columns, grid.rows, walls);
    sand::HeightField field(grid.columns, grid.rows, grid.cellSize);
    const std::string key = terrain.has("file") ? "file" : "z";
    const auto adviceFor = [&](double height) {
        return isUsualNoData(height) ? "declare it as no data, or set 'datum'" : "set 'datum'";
    };
    const auto unitsOf = [&](double height) {
        return heightUnits(terrain, key, height - datum, field.unit(), adviceFor(height));
    };
    layTerrain(grid, unitsOf, field, ground, partOf(checks.progress, kPixels, 1));
    return field;
}

sand::HeightField madeUp(const host::TomlTable& file, const host::TomlTable& terrain, bool withDunes,
                         const SizeChecks& checks) {
    sand::HeightField field = levelField(file, checks);
    const double bed = terrain.numberOr("height", 0);
    const std::int32_t units = heightUnits(terrain, "height", bed, field.unit());
    for (int row = 0; row < field.rows(); ++row) {
        std::fill_n(field.row(row), field.columns(), units);
    }
    if (withDunes) {
        sand::grid::Dunes dunes;
        dunes.bed = bed;
        dunes.height = terrain.numberOr("dune_height", dunes.height, {0, 1e9});
        dunes.length = terrain.numberOr("dune_length", dunes.length, host::kPositive);
        dunes.seed = static_cast<std::uint32_t>(terrain.integerOr("seed", 1, 0, 1 << 30));
        heightUnits(terrain, "dune_height", bed + dunes.height, field.unit());
        sand::grid::makeDunes(dunes, field);
    }
    return field;
}

/// Puts rock at `heightOf(column, row)` [unit] under every cell that is not a wall.
template <class HeightOf>
void layRock(const host::TomlTable& terrain, const std::string& key, const sand::HeightField& field,
             sand::Ground& ground, HeightOf heightOf) {
    for (int row = 0; row < field.rows(); ++row) {
        for (int column = 0; column < field.columns(); ++column) {
            if (ground.isWall(column, row)) {
                continue;
            }
            const std::int32_t rock = heightOf(column, row);
            if (rock > field.height(column, row)) {
                terrain.fail(key,
                             fmt::format("the layer of sand is {} thick in column {}, row {} (from the south-west); "
                                         "rock must lie at or below the sand",
                                         (field.height(column, row) - rock) * field.unit(), column + 1, row + 1));
            }
            ground.setBedrock(column, row, rock);
        }
    }
}

/// Reads `layer` or `bedrock`. `survey` is the raster of the terrain, without heights, if it is on a map. Rock must
/// then have the same place. Under other terrain only the number of cells must be the same.
void readBedrock(const host::TomlTable& terrain, const sand::HeightField& field, const SizeChecks& checks,
                 const std::optional<EsriGrid>& survey, std::shared_ptr<sand::Ground>& ground, Scene& scene) {
    if (terrain.has("layer") && terrain.has("bedrock")) {
        terrain.fail("bedrock", "give 'layer' or 'bedrock', not both: each gives the height of the rock");
    }
    if (terrain.has("layer")) {
        const std::int32_t layer = heightUnits(terrain, "layer", terrain.number("layer", {0, 1e9}), field.unit());
        layRock(terrain, "layer", field, groundOf(ground, field),
                [&](int column, int row) { return std::max(field.height(column, row) - layer, -sand::kMaxHeight); });
    }
    if (terrain.has("bedrock")) {
        const auto check = [&](const RasterSize& size) {
            if (checks.raster) {
                checks.raster(size);
            }
        };
        const EsriGrid rock = readRaster(terrain.folder() / terrain.text("bedrock"), {check, checks.progress});
        if (survey) {
            requireFit(*survey, rock);
        } else {
            requireSameUnits(scene.georeference.units,
                             terrain.has("file") ? terrain.text("file") : terrain.text("kind"), rock);
        }
        scene.statements->push_back(statementOf(rock));
        scene.warnings.insert(scene.warnings.end(), rock.warnings.begin(), rock.warnings.end());
        if (rock.columns != field.columns() || rock.rows != field.rows()) {
            terrain.fail("bedrock",
                         fmt::format("the rock has {} x {} cells, the terrain {} x {}: they must be the same",
                                     rock.columns, rock.rows, field.columns(), field.rows()));
        }
        const double datum = terrain.numberOr("datum", 0);
        layRock(terrain, "bedrock", field, groundOf(ground, field), [&](int column, int row) {
            const double height = rock.at(column, row);
            if (std::isnan(height)) {
                terrain.fail("bedrock",
                             fmt::format("no rock in column {}, row {} (from the south-west), where there is "
                                         "sand",
                                         column + 1, row + 1));
            }
            return heightUnits(terrain, "bedrock", height - datum, field.unit());
        });
    }
}

}  // namespace

bool readTerrain(const host::TomlTable& file, Scene& scene, const SizeChecks& checks) {
    const host::TomlTable terrain = file.requiredTable("terrain");
    std::vector<std::string_view> kinds{"flat", "dunes"};
    std::copy(sourceKinds().begin(), sourceKinds().end(), std::back_inserter(kinds));
    const int kind = terrain.choiceOr("kind", kinds, 0);
    std::shared_ptr<sand::Ground> ground;
    std::optional<EsriGrid> survey;
    scene.statements.emplace();
    const double above = terrain.has("bedrock") ? kAbove : 1;
    const SizeChecks ofSand{checks.raster, checks.field, checks.fieldAtMost, partOf(checks.progress, 0, above)};
    const SizeChecks ofRock{checks.raster, checks.field, checks.fieldAtMost, partOf(checks.progress, above, 1)};
    scene.terrain = kind < 2 ? madeUp(file, terrain, kind == 1, ofSand)
                             : fromSource(file, terrain, kind - 2, scene, survey, ground, ofSand);
    readBedrock(terrain, scene.terrain, ofRock, survey, ground, scene);
    const bool settle = terrain.flagOr("settle", false);
    terrain.finish();
    if (scene.tin == nullptr) {
        scene.rules.columns = scene.terrain.columns();
        scene.rules.rows = scene.terrain.rows();
    }
    scene.rules.ground = ground == nullptr ? 0 : ground->digest();
    scene.ground = ground;
    return settle;
}

}  // namespace scene
