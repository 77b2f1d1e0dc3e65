// SPDX-License-Identifier: Apache-2.0
#include "scene/load/terrain_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/input_error.hpp"
#include "sand/model/height_field.hpp"
#include "scene/import/esri_file.hpp"
#include "scene/import/gsf_file.hpp"
#include "scene/import/importer.hpp"
#include "scene/import/no_data.hpp"
#include "scene/import/raster_file.hpp"
#include "scene/import/raster_units.hpp"

namespace scene {
namespace {

std::filesystem::path fileOf(const host::TomlTable& terrain) { return terrain.folder() / terrain.text("file"); }

const Importer& importerFor(const host::TomlTable& terrain) {
    try {
        return loadImporter("kind = \"" + terrain.text("kind") + "\"");
    } catch (const base::InputError& error) {
        terrain.fail("kind", error.what());
    }
}

EsriGrid readDem(const host::TomlTable& terrain, const RasterCheck& check) {
    const Importer& importer = importerFor(terrain);
    const std::filesystem::path file = fileOf(terrain);
    return holdsEsriGrid(file) ? readTextWithUnits(file, importer, check) : readByGdal(file, importer, check);
}

EsriGrid readImage(const host::TomlTable& terrain, const RasterCheck& check) {
    const double low = terrain.numberOr("low", 0);
    const double high = terrain.number("high");
    if (!(high > low)) {
        terrain.fail("high", fmt::format("high must be above low = {}, got {}", low, high));
    }
    const double width = terrain.numberOr("width", 2.0, host::kPositive);
    const Colours colours = terrain.flagOr("brightness", false) ? Colours::brightness : Colours::none;
    EsriGrid image = importerFor(terrain).readImage(fileOf(terrain), colours, check);
    image.cellSize = width / image.columns;
    image.heights.multiply(high - low, low);
    return image;
}

/// Returns the range [from, to] of x or y.
std::pair<double, double> stretchOf(const host::TomlTable& terrain, const std::string& key) {
    const std::vector<double> ends = terrain.numbers(key, 2);
    if (!(ends[1] > ends[0]) || !std::isfinite(ends[1] - ends[0])) {
        terrain.fail(key, fmt::format("{} must go from less to more, got [{}, {}]", key, ends[0], ends[1]));
    }
    return {ends[0], ends[1]};
}

/// Reads a function. The rows follow from the columns, because cells are square. If the file gives rows, they must fit.
EsriGrid readFunction(const host::TomlTable& file, const host::TomlTable& terrain, const RasterCheck& check) {
    Function function;
    function.text = terrain.text("z");
    std::tie(function.west, function.east) = stretchOf(terrain, "x");
    std::tie(function.south, function.north) = stretchOf(terrain, "y");
    const host::TomlTable field = file.requiredTable("field");
    if (field.has("width")) {
        field.fail("width", "a function's width is that of its x");
    }
    function.columns = field.integerOr("columns", 512, 1, sand::kMaxSide);
    const double cell = (function.east - function.west) / function.columns;
    const double rows = (function.north - function.south) / cell;
    const double whole = std::floor(rows + 0.5);
    if (!(whole >= 1 && whole <= sand::kMaxSide) || std::abs(rows - whole) > 1e-6 * whole) {
        terrain.fail("y", fmt::format("{} columns make cells of {:.6g}, and y is {:.6g} of them long; that must be a "
                                      "whole number within [1, {}]",
                                      function.columns, cell, rows, sand::kMaxSide));
    }
    function.rows = static_cast<int>(whole);
    if (field.integerOr("rows", function.rows, 1, sand::kMaxSide) != function.rows) {
        field.fail("rows",
                   fmt::format("{} columns of x make {} rows of y; leave rows out", function.columns, function.rows));
    }
    field.finish();
    check({function.columns, function.rows, NumberSize::doubles, true});
    const Importer& importer = importerFor(terrain);
    try {
        return importer.evaluate(function, check);
    } catch (const base::InputError& error) {
        terrain.fail("z", error.what());
    }
}

/// Reads a scan. A scan is nanometres high. Its width becomes a few scene units. Its heights grow with the width, and
/// by 'exaggeration'.
TerrainSource readScan(const host::TomlTable& terrain, const RasterCheck& check) {
    const double width = terrain.numberOr("width", 2.0, host::kPositive);
    const double exaggeration = terrain.numberOr("exaggeration", 1, host::kPositive);
    TerrainSource source{.raster = readGsf(fileOf(terrain), check)};
    EsriGrid& scan = source.raster;
    Georeference& reference = source.georeference;
    reference.lengthPerUnit = scan.cellSize * scan.columns / width;
    reference.heightPerUnit = reference.lengthPerUnit / exaggeration;
    const auto failToScale = [&] {
        terrain.fail("file", scan.file + " is too small or too large for heights to be scaled; its XReal is in metres");
    };
    if (!std::isnormal(reference.lengthPerUnit) || !std::isnormal(reference.heightPerUnit)) {
        failToScale();  // 0 divided by 0 would count as no data
    }
    scan.cellSize = width / scan.columns;
    if (scan.cellDepth) {
        *scan.cellDepth /= reference.lengthPerUnit;
    }
    scan.heights.divide(reference.heightPerUnit);
    if (std::any_of(scan.heights.begin(), scan.heights.end(), [](double height) { return std::isinf(height); })) {
        failToScale();
    }
    return source;
}

enum Kind { kEsriAscii, kDem, kImage, kFunction, kGsf, kPoints };

TerrainSource readKind(const host::TomlTable& file, const host::TomlTable& terrain, int kind,
                       const RasterCheck& check) {
    switch (kind) {
        case kDem:
            return {.raster = readDem(terrain, check)};
        case kImage:
            return {.raster = readImage(terrain, check)};
        case kFunction:
            return {.raster = readFunction(file, terrain, check)};
        case kGsf:
            return readScan(terrain, check);
        case kPoints:
            return {.points = readPoints(fileOf(terrain), [&check](double share) { check.read(share); })};
        default:
            return {.raster = readEsriGrid(fileOf(terrain), check)};
    }
}

}  // namespace

Georeference TerrainSource::referenceAt(const EsriGrid& part) const {
    Georeference result = georeference;
    result.west = part.westEdge * georeference.lengthPerUnit;
    result.south = part.southEdge * georeference.lengthPerUnit;
    return result;
}

const std::vector<std::string_view>& sourceKinds() {
    static const std::vector<std::string_view> kKinds = {"esri_ascii", "dem", "image", "function", "gsf", "points"};
    return kKinds;
}

TerrainSource readSource(const host::TomlTable& file, const host::TomlTable& terrain, int kind,
                         const RasterCheck& check) {
    if (kind != kFunction && file.has("field")) {
        file.fail("field", "[field] is for flat, dunes and functions; a file brings its own columns, rows and cells");
    }
    TerrainSource source = readKind(file, terrain, kind, check);
    source.georeference.units = source.raster.units;
    source.onMap = kind == kDem || kind == kEsriAscii;
    if (source.onMap || kind == kGsf) {
        source.statement = statementOf(source.raster);
    } else if (kind == kPoints) {
        source.statement = statementOf(source.points, fileOf(terrain).string());
    }
    source.warnings =
        source.points.empty() ? source.raster.warnings : undeclaredNoData(source.points, fileOf(terrain).string());
    source.georeference.datum = terrain.numberOr("datum", 0);
    return source;
}

}  // namespace scene
