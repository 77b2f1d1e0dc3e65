// SPDX-License-Identifier: Apache-2.0
#include "scene/gdal/gdal_reference.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "base/input_error.hpp"
#include "base/text.hpp"
#include "base/text_reader.hpp"
#include "scene/gdal/claims.hpp"
#include "scene/gdal/length_unit.hpp"
#include "scene/import/metric_system.hpp"
#include "scene/import/prj_file.hpp"

namespace scene {
namespace {

/// Returns the command that converts degrees to metres. It uses the UTM zone of the raster's middle, or a system around
/// a pole. `reference` may be null, which means degrees of WGS 84.
std::string warpCommandOf(const GdalRaster& raster, OGRSpatialReferenceH reference) {
    std::array<double, 6> place{};
    double longitude = std::nan(""), latitude = std::nan("");
    const double degrees = reference == nullptr ? 1 : OSRGetAngularUnits(reference, nullptr) / 0.017453292519943295;
    if (GDALGetGeoTransform(raster.dataset(), place.data()) == CE_None) {
        longitude = (place[0] + place[1] * raster.columns() / 2) * degrees;
        latitude = (place[3] + place[5] * raster.rows() / 2) * degrees;
    }
    return warpCommand(raster.name(), longitude, latitude, reference == nullptr ? "-s_srs EPSG:4326 " : "");
}

std::string textOf(OGRSpatialReferenceH reference, const char* format) {
    char* text = nullptr;
    const std::array<const char*, 3> options = {format, "MULTILINE=NO", nullptr};
    const OGRErr error = OSRExportToWktEx(reference, &text, options.data());
    const GdalText owner(text);
    return error == OGRERR_NONE && text != nullptr ? text : "";
}

/// Reads a .prj file if the driver of the raster has not read it. GDAL 3.6.2 takes only ESRI's WKT and lines of
/// ArcInfo, and takes any other text for no system.
SpatialReference referenceOf(const PrjFile& prj) {
    const std::string text(base::trimmed(prj.text.substr(0, prj.text.find_last_not_of(" \t\n") + 1)));
    SpatialReference reference(OSRNewSpatialReference(nullptr));
    std::string wkt = text;
    char* rest = wkt.data();
    // WKT first, because GDAL's reader of ESRI's form accepts any word before a bracket.
    bool good = text.find('[') != std::string::npos && OSRImportFromWkt(reference.get(), &rest) == OGRERR_NONE;
    if (!good) {
        reference.reset(OSRNewSpatialReference(nullptr));
        std::vector<std::string> lines;
        base::TextReader reader(text, prj.file.string());
        for (std::string_view line; reader.nextLine(line);) {
            lines.emplace_back(line);
        }
        std::vector<char*> list;
        list.reserve(lines.size() + 1);
        for (std::string& line : lines) {
            list.push_back(line.data());
        }
        list.push_back(nullptr);
        good = !lines.empty() && OSRImportFromESRI(reference.get(), list.data()) == OGRERR_NONE;
    }
    if (!good) {
        reference.reset(OSRNewSpatialReference(nullptr));
        good = text.starts_with("+proj") && OSRImportFromProj4(reference.get(), text.c_str()) == OGRERR_NONE;
    }
    const auto isHorizontal = [](OGRSpatialReferenceH system) {
        return OSRIsProjected(system) != 0 || OSRIsGeographic(system) != 0 || OSRIsGeocentric(system) != 0 ||
               OSRIsLocal(system) != 0;
    };
    if (!good || !isHorizontal(reference.get())) {
        throw base::InputError(
            fmt::format("{}: its coordinate system cannot be read, so that the unit of lengths is unknown; write it as "
                        "WKT, or remove "
                        "the file if the raster is in lengths",
                        prj.file.string()));
    }
    return reference;
}

/// Sets the unit of lengths from a coordinate system. Refuses degrees.
void readReference(const GdalRaster& raster, OGRSpatialReferenceH reference, RasterDescription& described) {
    const char* unit = nullptr;
    described.units.lengthMetres = OSRGetLinearUnits(reference, const_cast<char**>(&unit));
    const bool local = OSRIsProjected(reference) == 0;
    const std::optional<std::string> named = local ? lengthUnitInHeader(raster) : std::nullopt;
    if (OSRIsGeographic(reference) != 0 || OSRIsGeocentric(reference) != 0 ||
        (local && unit != nullptr && isAngle(unit)) || (named && isAngle(*named))) {
        const char* name = OSRGetName(reference);
        raster.fail(fmt::format("its coordinates ({}) are degrees, but sand needs lengths; make metres of them: {}",
                                name == nullptr ? "no name" : name, warpCommandOf(raster, reference)));
    }
    if (named && !meansNoUnit(*named) && !metresOf(*named)) {
        raster.fail(
            fmt::format("its lengths are in '{}', which is not a known unit; write its coordinates in metres", *named));
    }
    described.units.crs = textOf(reference, "FORMAT=WKT2");
    const char* const code = OSRGetAuthorityCode(reference, nullptr);
    const char* const authority = OSRGetAuthorityName(reference, nullptr);
    const char* const name = OSRGetName(reference);
    if (code != nullptr && authority != nullptr) {
        described.origins.across = fmt::format("{}:{}", authority, code);
    } else {
        const bool hasName = name != nullptr && std::string_view(name) != "unnamed";
        described.origins.across = hasName ? name : "coordinate system";
    }
}

/// Sets the unit of lengths from the axes of a NetCDF file without a coordinate system. GDAL leaves it to its users to
/// read them.
void readAxes(const GdalRaster& raster, RasterDescription& described) {
    const char* const own = GDALGetMetadataItem(raster.band(), "NETCDF_VARNAME", nullptr);
    char** const items = GDALGetMetadata(raster.dataset(), nullptr);
    std::string firstUnit, firstAxis;
    for (char** item = items; own != nullptr && item != nullptr && *item != nullptr; ++item) {
        const std::string_view text = *item;
        constexpr std::string_view kUnits = "#units=";
        const std::size_t at = text.find(kUnits);
        if (at == std::string_view::npos || text.substr(0, at) == own) {
            continue;
        }
        const std::string axis(text.substr(0, at)), unit(text.substr(at + kUnits.size()));
        if (isAngle(unit)) {
            raster.fail(fmt::format("its axis '{}' is in {}, but sand needs lengths; make metres of them: {}", axis,
                                    unit, warpCommandOf(raster, nullptr)));
        }
        const std::string name =
            GDALGetMetadataItem(raster.dataset(), (axis + "#standard_name").c_str(), nullptr) == nullptr
                ? ""
                : GDALGetMetadataItem(raster.dataset(), (axis + "#standard_name").c_str(), nullptr);
        const bool horizontal =
            name.starts_with("projection_") || axis == "x" || axis == "y" || axis == "easting" || axis == "northing";
        if (!horizontal || meansNoUnit(unit)) {
            continue;
        }
        const std::optional<double> metres = metresOf(unit);
        if (!metres) {
            raster.fail(fmt::format(
                "its axis '{}' is in '{}', which is not a known unit of length; write the axis in metres", axis, unit));
        }
        if (!firstUnit.empty() && *metres != described.units.lengthMetres) {
            raster.fail(fmt::format("its axis '{}' is in {}, and '{}' in {}; write both in metres", firstAxis,
                                    firstUnit, axis, unit));
        }
        described.units.lengthMetres = *metres;
        described.origins.across = "axes";
        firstUnit = unit;
        firstAxis = axis;
    }
}

/// A unit of heights that something declares.
struct Declared {
    double metres = 0;
    std::string name, by;
};

/// Returns the unit of heights of the vertical part of a coordinate system.
std::optional<Declared> verticalUnit(OGRSpatialReferenceH reference) {
    if (reference == nullptr || OSRIsCompound(reference) == 0) {
        return std::nullopt;
    }
    const char* name = nullptr;
    const double metres = OSRGetTargetLinearUnits(reference, "VERT_CS", const_cast<char**>(&name));
    return Declared{metres, name == nullptr ? "" : name, "vertical datum"};
}

std::optional<Declared> declaredUnit(const GdalRaster& raster, const std::string& name, const std::string& by) {
    if (meansNoUnit(name)) {
        return std::nullopt;
    }
    const std::optional<double> metres = metresOf(name);
    if (!metres) {
        raster.fail(
            fmt::format("heights in '{}' ({}), which is not a known unit; known are m, ft, us-ft, cm, mm and km; "
                        "set it: gdal_edit.py -units m",
                        name, by));
    }
    return Declared{*metres, name, by};
}

/// Sets the unit of heights. Two declarations must agree.
void readHeightUnit(const GdalRaster& raster, OGRSpatialReferenceH reference, const std::optional<PrjFile>& prj,
                    RasterDescription& described) {
    const char* const type = GDALGetRasterUnitType(raster.band());
    const std::optional<Declared> band = declaredUnit(raster, type == nullptr ? "" : type, "band");
    std::optional<Declared> other = verticalUnit(reference);
    if (!other && prj && prj->heightUnit()) {
        other = declaredUnit(raster, *prj->heightUnit(), prj->file.filename().string());
    }
    constexpr double kSame = 1e-9;
    if (band && other && std::abs(band->metres - other->metres) > kSame * other->metres) {
        raster.fail(
            fmt::format("its heights are in '{}' ({}) or in '{}' ({}); set the right unit: gdal_edit.py -units {}, "
                        "or -a_srs with another vertical datum",
                        band->name, band->by, other->name, other->by, other->name));
    }
    RasterUnits& units = described.units;
    if (const std::optional<Declared>& found = band ? band : other) {
        units.heightMetres = found->metres;
        // A vertical datum travels with the coordinate system. Other declarations need a name.
        units.heightName = band ? band->name : other->by == "vertical datum" ? "" : other->name;
        described.origins.up = found->by;
    }
}

}  // namespace

RasterDescription describe(const GdalRaster& raster) {
    RasterDescription described;
    RasterUnits& units = described.units;
    const std::optional<PrjFile> prj = prjBeside(raster.name());
    OGRSpatialReferenceH reference = GDALGetSpatialRef(raster.dataset());
    SpatialReference owner;
    if (reference == nullptr && prj) {
        owner = referenceOf(*prj);
        reference = owner.get();
    }
    if (reference != nullptr) {
        readReference(raster, reference, described);
    } else {
        readAxes(raster, described);
    }
    readHeightUnit(raster, reference, prj, described);
    constexpr double kKilometre = 1000;  // [m]
    if (units.heightMetres == 0 && units.lengthMetres >= kKilometre) {
        raster.fail(fmt::format(
            "its lengths are in units of {} m ({}), and it does not declare the unit of its heights, which could be "
            "the same or metres; set the unit: gdal_edit.py -units m (of a GeoTIFF, which gdal_translate makes)",
            units.lengthMetres, described.origins.across));
    }
    if (units.heightMetres == 0) {
        units.heightMetres = units.lengthMetres;  // heights without a unit have that of lengths
    } else if (units.lengthMetres == 0) {
        units.lengthMetres = units.heightMetres;  // lengths without a unit have that of heights
        described.origins.across = "unit of heights";
    }
    if (units.heightMetres != units.lengthMetres) {
        units.heightsPerLength = units.lengthMetres / units.heightMetres;
    }
    return described;
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

std::string esriTextOf(OGRSpatialReferenceH reference) { return textOf(reference, "FORMAT=WKT1_ESRI"); }

bool haveSamePlaces(OGRSpatialReferenceH a, OGRSpatialReferenceH b) {
    OSRStripVertical(a);
    OSRStripVertical(b);
    const std::array<const char*, 3> options = {"CRITERION=EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS",
                                                "IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES", nullptr};
    if (OSRIsSameEx(a, b, options.data()) != 0) {
        return true;
    }
    // The order of the axes may be all that differs, but rasters have east first, whatever a definition says. ESRI's
    // form has no order.
    const std::string one = esriTextOf(a), other = esriTextOf(b);
    return !one.empty() && !other.empty() &&
           OSRIsSameEx(referenceOf(one, "").get(), referenceOf(other, "").get(), options.data()) != 0;
}

}  // namespace scene
