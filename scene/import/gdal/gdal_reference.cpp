// SPDX-License-Identifier: Apache-2.0
#include "scene/import/gdal/gdal_reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include "base/input_error.hpp"
#include "base/text.hpp"
#include "scene/import/metric_system.hpp"

namespace scene {
namespace {

struct HeightUnit {
    std::string_view name;
    double metres;
};
// Names that GDAL's drivers, EPSG and users give to units.
constexpr std::array kHeightUnits = {
    HeightUnit{"m", 1},
    HeightUnit{"metre", 1},
    HeightUnit{"meter", 1},
    HeightUnit{"metres", 1},
    HeightUnit{"meters", 1},
    HeightUnit{"ft", 0.3048},
    HeightUnit{"foot", 0.3048},
    HeightUnit{"feet", 0.3048},
    HeightUnit{"us-ft", 1200.0 / 3937},
    HeightUnit{"ftus", 1200.0 / 3937},
    HeightUnit{"us survey foot", 1200.0 / 3937},
    HeightUnit{"foot_us", 1200.0 / 3937},
    HeightUnit{"cm", 0.01},
    HeightUnit{"mm", 0.001},
    HeightUnit{"km", 1000},
};

double metresOf(const std::string& unit, const GdalRaster& raster) {
    const std::string lower = base::lowerCase(unit);
    const auto* found = std::find_if(kHeightUnits.begin(), kHeightUnits.end(),
                                     [&](const HeightUnit& candidate) { return candidate.name == lower; });
    if (found == kHeightUnits.end()) {
        raster.fail(
            fmt::format("heights in '{}', which is not a known unit; set their unit: gdal_edit.py "
                        "-units m",
                        unit));
    }
    return found->metres;
}

/// Returns the command that converts degrees to metres. It uses the UTM zone of the raster's middle, or a system around
/// a pole.
std::string warpCommandOf(const GdalRaster& raster, OGRSpatialReferenceH reference) {
    std::array<double, 6> place{};
    double longitude = std::nan(""), latitude = std::nan("");
    const double degrees = OSRGetAngularUnits(reference, nullptr) / 0.017453292519943295;
    if (GDALGetGeoTransform(raster.dataset(), place.data()) == CE_None) {
        longitude = (place[0] + place[1] * raster.columns() / 2) * degrees;
        latitude = (place[3] + place[5] * raster.rows() / 2) * degrees;
    }
    return warpCommand(raster.name(), longitude, latitude);
}

std::string wktOf(OGRSpatialReferenceH reference) {
    char* text = nullptr;
    const std::array<const char*, 3> options = {"FORMAT=WKT2", "MULTILINE=NO", nullptr};
    const OGRErr error = OSRExportToWktEx(reference, &text, options.data());
    const GdalText owner(text);
    return error == OGRERR_NONE && text != nullptr ? text : "";
}

}  // namespace

RasterUnits unitsOf(const GdalRaster& raster) {
    RasterUnits units;
    if (const char* name = GDALGetRasterUnitType(raster.band()); name != nullptr && *name != '\0') {
        units.heightName = name;
        units.heightMetres = metresOf(name, raster);
    }
    OGRSpatialReferenceH reference = GDALGetSpatialRef(raster.dataset());
    if (reference == nullptr) {
        units.lengthMetres = units.heightMetres;  // without a reference system, lengths have the unit of heights
        return units;
    }
    if (OSRIsGeographic(reference) != 0 || OSRIsGeocentric(reference) != 0) {
        const char* name = OSRGetName(reference);
        raster.fail(fmt::format("its coordinates ({}) are degrees, but sand needs lengths; make metres of them: {}",
                                name == nullptr ? "no name" : name, warpCommandOf(raster, reference)));
    }
    units.crs = wktOf(reference);
    units.lengthMetres = OSRGetLinearUnits(reference, nullptr);
    if (units.heightName.empty()) {
        const bool vertical = OSRIsCompound(reference) != 0;
        units.heightMetres = vertical ? OSRGetTargetLinearUnits(reference, "VERT_CS", nullptr) : units.lengthMetres;
    }
    if (units.heightMetres != units.lengthMetres) {
        units.heightsPerLength = units.lengthMetres / units.heightMetres;
    }
    return units;
}

SpatialReference referenceOf(const std::string& crs, const std::string& file) {
    SpatialReference reference(OSRNewSpatialReference(nullptr));
    std::string text = crs;
    char* rest = text.data();
    // Does not use GDAL's SetFromUserInput, because that also accepts addresses of servers.
    if (OSRImportFromWkt(reference.get(), &rest) != OGRERR_NONE) {
        throw base::InputError(file + ": GDAL does not know the coordinate reference system of the terrain");
    }
    return reference;
}

}  // namespace scene
