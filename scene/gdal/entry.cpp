// SPDX-License-Identifier: Apache-2.0
// Functions that sandwall-import.so exports.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

#include "base/input_error.hpp"
#include "scene/gdal/function_text.hpp"
#include "scene/gdal/gdal_geotiff.hpp"
#include "scene/gdal/gdal_reference.hpp"
#include "scene/gdal/header_in_memory.hpp"
#include "scene/import/importer.hpp"

namespace scene {
namespace {

constexpr double kSquare = 1e-6;  // largest difference of a cell's sides, as a share; other programs print fewer digits

/// Sets the raster's place from GDAL's (west, width, turn, north, turn, depth).
void setPlace(const GdalRaster& raster, EsriGrid& grid) {
    std::array<double, 6> place{};
    if (GDALGetGeoTransform(raster.dataset(), place.data()) != CE_None) {
        raster.fail("has no position and no pixel size; kind = \"image\" takes pictures");
    }
    for (const double number : place) {
        if (!std::isfinite(number)) {
            raster.fail("its place is not finite");
        }
    }
    const auto [west, width, turn, north, otherTurn, depth] = place;
    // Programs leave rounding errors where a raster is not turned. The farthest corner then moves by less than this.
    constexpr double kTurned = 1e-3;  // [cell]
    const bool turned = std::abs(turn) * raster.rows() > kTurned * width ||
                        std::abs(otherTurn) * raster.columns() > kTurned * std::abs(depth);
    if (turned || !(width > 0) || depth == 0) {
        raster.fail(fmt::format("is turned or mirrored; straighten it: gdalwarp -r bilinear {} straight.tif",
                                std::filesystem::path(raster.name()).filename().string()));
    }
    grid.cellSize = width;
    grid.westEdge = west;
    grid.southEdge = depth < 0 ? north + depth * grid.rows : north;
    if (std::abs(std::abs(depth) - width) > kSquare * width) {
        grid.cellDepth = std::abs(depth);
    }
    // Some programs write these numbers if they know no place, and GDAL returns them as a place.
    const bool atOrigin = west == 0 && (grid.southEdge == 0 || north == 0);
    if (grid.units.crs.empty() && width == 1 && std::abs(depth) == 1 && atOrigin) {
        grid.warnings.push_back(fmt::format(
            "{}: has no coordinate system, and cells of 1 x 1 at (0, 0), as if it had no georeferencing; slopes are "
            "wrong if its cells have another size: gdal_edit.py -a_ullr WEST NORTH EAST SOUTH {}",
            grid.file, std::filesystem::path(grid.file).filename().string()));
    }
    if (depth > 0) {  // the first row is the southernmost
        grid.heights.turnOver(grid.columns);
    }
}

EsriGrid gridOf(const GdalRaster& raster) {
    EsriGrid grid;
    grid.file = raster.name();
    grid.columns = raster.columns();
    grid.rows = raster.rows();
    return grid;
}

/// Returns the largest number that a pixel of an image can have.
double whiteOf(const GdalRaster& raster) {
    const char* bits = GDALGetMetadataItem(raster.band(), "NBITS", "IMAGE_STRUCTURE");
    switch (GDALGetRasterDataType(raster.band())) {
        case GDT_Byte:
        case GDT_UInt16:
            if (bits != nullptr) {
                return std::exp2(std::clamp(std::atoi(bits), 1, 16)) - 1;
            }
            return GDALGetRasterDataType(raster.band()) == GDT_Byte ? 255 : 65535;
        default:
            raster.fail(
                fmt::format("holds {} numbers; an image's are of 8 or 16 bits without sign, and kind = \"dem\" "
                            "takes others",
                            GDALGetDataTypeName(GDALGetRasterDataType(raster.band()))));
    }
}

void ask(const RasterCheck& check, const GdalRaster& raster) {
    check({raster.columns(), raster.rows(), raster.numberSize(), raster.complete()});
}

class GdalImporter final : public Importer {
public:
    [[nodiscard]] EsriGrid readDem(const std::filesystem::path& file, const RasterCheck& check) const override {
        const GdalRaster raster(file);
        EsriGrid grid = gridOf(raster);
        const RasterDescription described = describe(raster);  // refuses a raster in degrees before it is read
        grid.units = described.units;
        grid.origins = described.origins;
        ask(check, raster);
        grid.heights = raster.pixels(check);
        setPlace(raster, grid);
        grid.noData = raster.noData();
        grid.countHeightsInLengths();
        const std::vector<std::string> warnings = raster.warnings();
        grid.warnings.insert(grid.warnings.begin(), warnings.begin(), warnings.end());
        return grid;
    }
    [[nodiscard]] RasterDescription readUnits(const std::filesystem::path& file) const override {
        const HeaderInMemory header(file);
        const GdalRaster raster(file, header.path());
        RasterDescription described = describe(raster);
        described.warnings = raster.warnings();
        return described;
    }
    [[nodiscard]] EsriGrid readImage(const std::filesystem::path& file, Colours colours,
                                     const RasterCheck& check) const override {
        const GdalRaster raster(file, {}, colours);
        if (raster.isWhiteZero()) {
            raster.fail(
                "its 0 is white, so that it could be the lowest or the highest; invert it, or read its numbers as "
                "heights with kind = \"dem\"");
        }
        const double white = whiteOf(raster);
        EsriGrid grid = gridOf(raster);
        ask(check, raster);
        grid.cellSize = 1;
        grid.heights = raster.pixels(check);
        grid.heights.divide(white);
        grid.warnings = raster.warnings();
        return grid;
    }
    [[nodiscard]] EsriGrid evaluate(const Function& function, const RasterCheck& check) const override {
        return evaluateFunction(function, check);
    }
    [[nodiscard]] base::Bytes geoTiff(const EsriGrid& grid, const std::string& file) const override {
        return geoTiffOf(grid, file);
    }
    [[nodiscard]] std::string esriWkt(const std::string& crs, const std::string& file) const override {
        const GdalSession session;
        const SpatialReference reference = referenceOf(crs, file);
        OSRStripVertical(reference.get());  // heights of the grid are in the unit of lengths, whatever it says
        std::string text = esriTextOf(reference.get());
        if (text.empty()) {
            throw base::InputError(file +
                                   ": its coordinate reference system cannot be said in a .prj file; write a "
                                   ".tif: " +
                                   session.complaint());
        }
        return text;
    }
    [[nodiscard]] bool sameSystem(const std::string& one, const std::string& other,
                                  const std::string& file) const override {
        const GdalSession session;
        const SpatialReference a = referenceOf(one, file), b = referenceOf(other, file);
        return haveSamePlaces(a.get(), b.get());
    }
};

}  // namespace
}  // namespace scene

extern "C" const scene::Importer* sandwallImport8() {
    static const scene::GdalImporter kImporter;
    return &kImporter;
}
