// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "scene/load/scene_file.hpp"
#include "tests/support/files/scene_fixture.hpp"
#include "tests/support/processes/run_program.hpp"

/// Number that writeRaster() adds to a negative byte with a sign. GDAL 3.6 has no type for such bytes, and takes bytes
/// without a sign for them.
#if GDAL_VERSION_NUM >= GDAL_COMPUTE_VERSION(3, 7, 0)
inline constexpr int kNegativeByte = 0;
#else
inline constexpr int kNegativeByte = 256;
#endif

/// Raster file to write; rows from the north.
struct Raster {
    int columns = 1, rows = 1;
    std::vector<double> heights{};
    std::optional<std::array<double, 6>> place{{1000, 10, 0, 2000, 0, -10}};  // in GDAL's order
    int epsg = 32633;                                                         // 0 without a system
    GDALDataType type = GDT_Float32;
    std::optional<double> noData{};
    const char* unit = nullptr;
    const char* driver = "GTiff";
    int bands = 1;
    std::vector<const char*> options{};
    const char* pixelIs = nullptr;  // "Area" or "Point"
};

/// Writes rasters through GDAL, and runs scenes and programs that read them.
class Import : public SceneFile {
protected:
    void SetUp() override { GDALAllRegister(); }

    [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }

    /// Writes a raster. Formats such as PNG are copied from a raster in memory, because their drivers cannot create
    /// one.
    void writeRaster(const std::string& name, Raster raster) const {
        raster.options.push_back(nullptr);
        GDALDriverH driver = GDALGetDriverByName(raster.driver);
        const bool copies = std::string(raster.driver) != "GTiff";
        GDALDatasetH dataset =
            GDALCreate(copies ? GDALGetDriverByName("MEM") : driver, copies ? "" : path(name).c_str(), raster.columns,
                       raster.rows, raster.bands, raster.type, copies ? nullptr : raster.options.data());
        if (dataset == nullptr) {
            throw std::runtime_error("GDAL cannot write " + name);
        }
        describe(dataset, raster);
        if (copies) {
            GDALDatasetH copy =
                GDALCreateCopy(driver, path(name).c_str(), dataset, FALSE, raster.options.data(), nullptr, nullptr);
            GDALClose(copy);
        }
        GDALClose(dataset);
    }

    /// Writes a coordinate reference system in the form of the file beside a text grid.
    void writePrj(const std::string& name, int epsg) {
        OGRSpatialReferenceH reference = OSRNewSpatialReference(nullptr);
        OSRImportFromEPSG(reference, epsg);
        char* wkt = nullptr;
        OSRExportToWkt(reference, &wkt);
        write(name, wkt);
        CPLFree(wkt);
        OSRDestroySpatialReference(reference);
    }

    /// Loads the scene of a terrain, with defaults for everything else. The tool is large enough to avoid a warning.
    [[nodiscard]] scene::Scene load(const std::string& terrain) {
        return scene::loadScene(write("s.toml", text(terrain)));
    }
    [[nodiscard]] std::string refusal(const std::string& terrain) {
        std::string line = complaint(text(terrain));
        for (std::size_t at = 0; (at = line.find(folder_.string() + "/")) != std::string::npos;) {
            line.erase(at, folder_.string().size() + 1);
        }
        return line;
    }
    [[nodiscard]] static std::string text(const std::string& terrain) {
        return terrain + "\n[material]\n[tool]\nradius = 0.5\n";
    }

private:
    static void describe(GDALDatasetH dataset, Raster& raster) {
        if (raster.place) {
            GDALSetGeoTransform(dataset, raster.place->data());
        }
        if (raster.pixelIs != nullptr) {
            GDALSetMetadataItem(dataset, "AREA_OR_POINT", raster.pixelIs, nullptr);
        }
        if (raster.epsg != 0) {
            OGRSpatialReferenceH reference = OSRNewSpatialReference(nullptr);
            OSRImportFromEPSG(reference, raster.epsg);
            GDALSetSpatialRef(dataset, reference);
            OSRDestroySpatialReference(reference);
        }
        for (int number = 1; number <= raster.bands; ++number) {
            GDALRasterBandH band = GDALGetRasterBand(dataset, number);
            if (raster.noData) {
                GDALSetRasterNoDataValue(band, *raster.noData);
            }
            if (raster.unit != nullptr) {
                GDALSetRasterUnitType(band, raster.unit);
            }
            if (!raster.heights.empty() &&
                GDALRasterIO(band, GF_Write, 0, 0, raster.columns, raster.rows, raster.heights.data(), raster.columns,
                             raster.rows, GDT_Float64, 0, 0) != CE_None) {
                throw std::runtime_error("GDAL cannot write heights");
            }
        }
    }
};
