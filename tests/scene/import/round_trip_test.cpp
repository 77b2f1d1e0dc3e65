// SPDX-License-Identifier: Apache-2.0
// Written files come back with the same heights and the same place: here, in GDAL, and in CGAL.
#include <CGAL/IO/PLY.h>
#include <CGAL/Simple_cartesian.h>
#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "scene/import/importer.hpp"
#include "scene/import/mesh_file.hpp"
#include "scene/import/raster_file.hpp"
#include "tests/scene/import/import_fixture.hpp"
#include "tests/scene/import/raster_forms.hpp"

namespace {

/// A raster with the units that a user's file may have. `heightsPerLength` is derived from the names of both units.
struct Case {
    const char* name;
    const char* system;  // as OSRSetFromUserInput() reads it; null without a system
    const char* unit;    // of the band; null if it declares none
    double heightsPerLength;
};

constexpr double kUsFootOfTrip = 1200.0 / 3937;  // [m]
constexpr std::array kCases{
    Case{"nothing declared", nullptr, nullptr, 1},
    Case{"metres", "EPSG:32633", nullptr, 1},
    Case{"metres, and metres of the band", "EPSG:32633", "m", 1},
    Case{"metres, and feet of the band", "EPSG:32633", "ft", 1 / 0.3048},
    Case{"metres, and US survey feet of the vertical datum", "EPSG:32633+6360", nullptr, 1 / kUsFootOfTrip},
    Case{"US survey feet, and metres of the vertical datum", "EPSG:2263+5703", nullptr, kUsFootOfTrip},
    Case{"US survey feet", "EPSG:2263", nullptr, 1},
};

class RoundTrip : public Import {
protected:
    /// Writes 3 x 2 heights, one of them without data, as a GeoTIFF in these units.
    void writeCase(const Case& given) const {
        writeRaster("t.tif", {.columns = 3,
                              .rows = 2,
                              .heights = {1.25, -2, -9999, 4, 5.5, 6},
                              .epsg = 0,
                              .type = GDT_Float64,
                              .noData = -9999,
                              .unit = given.unit});
        if (given.system == nullptr) {
            return;
        }
        GDALDatasetH dataset = GDALOpen(path("t.tif").c_str(), GA_Update);
        OGRSpatialReferenceH reference = OSRNewSpatialReference(nullptr);
        OSRSetFromUserInput(reference, given.system);
        GDALSetSpatialRef(dataset, reference);
        OSRDestroySpatialReference(reference);
        GDALClose(dataset);
    }
    static void expectSame(const scene::EsriGrid& grid, const scene::EsriGrid& again, const std::string& what) {
        ASSERT_EQ(again.heights.size(), grid.heights.size()) << what;
        for (std::size_t i = 0; i < grid.heights.size(); ++i) {
            EXPECT_EQ(std::isnan(again.heights[i]), std::isnan(grid.heights[i])) << what;
            if (!std::isnan(grid.heights[i])) {
                EXPECT_NEAR(again.heights[i], grid.heights[i], 1e-14 * std::abs(grid.heights[i])) << what;
            }
        }
        EXPECT_EQ(again.westEdge, grid.westEdge) << what;
        EXPECT_EQ(again.southEdge, grid.southEdge) << what;
        EXPECT_EQ(again.cellSize, grid.cellSize) << what;
        EXPECT_EQ(again.units.lengthMetres, grid.units.lengthMetres) << what;
        EXPECT_EQ(again.units.crs.empty(), grid.units.crs.empty()) << what;
        if (!grid.units.crs.empty()) {
            EXPECT_TRUE(scene::loadImporter("a test").sameSystem(grid.units.crs, again.units.crs, what));
        }
    }
    /// Returns the codes of the system that GDAL reads from a file, such as "EPSG:32633+6360"; empty without a system.
    /// ESRI's form has no codes, so that GDAL looks for the code of the same system.
    [[nodiscard]] std::string codesOf(const std::string& file) const {
        GDALDatasetH dataset = GDALOpen(path(file).c_str(), GA_ReadOnly);
        OGRSpatialReferenceH reference = GDALGetSpatialRef(dataset);
        std::string codes;
        if (reference != nullptr) {
            const char* const own = OSRGetAuthorityCode(reference, "PROJCS");
            codes = "EPSG:" + (own != nullptr ? std::string(own) : likelyCode(reference));
            if (const char* const vertical = OSRGetAuthorityCode(reference, "VERT_CS")) {
                codes += std::string("+") + vertical;
            }
        }
        GDALClose(dataset);
        return codes;
    }

private:
    static std::string likelyCode(OGRSpatialReferenceH reference) {
        int count = 0;
        int* confidence = nullptr;
        OGRSpatialReferenceH* const found = OSRFindMatches(reference, nullptr, &count, &confidence);
        std::string code = "none";
        if (count > 0 && confidence[0] >= 90) {
            code = OSRGetAuthorityCode(found[0], nullptr);
        }
        OSRFreeSRSArray(found);
        CPLFree(confidence);
        return code;
    }
};

TEST_F(RoundTrip, ARasterComesBackWithItsUnits) {
    for (const Case& given : kCases) {
        writeCase(given);
        const scene::EsriGrid grid = scene::readRaster(path("t.tif"));
        EXPECT_NEAR(grid.units.heightsPerLength, given.heightsPerLength, 1e-12 * given.heightsPerLength) << given.name;
        for (const char* file : {"out.tif", "out.asc"}) {
            std::filesystem::remove(path("out.prj"));
            scene::writeRaster(grid, path(file));
            const bool text = std::string(file) == "out.asc";
            const scene::EsriGrid again = scene::readRaster(path(file));
            expectSame(grid, again, fmt::format("{}, {}", given.name, file));
            const double heightsPerLength = text ? 1 : given.heightsPerLength;
            EXPECT_NEAR(again.units.heightsPerLength, heightsPerLength, 1e-12 * heightsPerLength)
                << given.name << ", " << file;
            // GDAL reads the file's own unit: that of the source in a GeoTIFF, that of lengths in a text.
            const std::optional<test::GdalValues> values = test::valuesOf(path(file), text ? "AAIGrid" : "GTiff");
            ASSERT_TRUE(values) << given.name << file;
            for (std::size_t i = 0; i < grid.heights.size(); ++i) {
                const double expected = grid.heights[i] * heightsPerLength;
                EXPECT_TRUE(std::isnan(expected) ? std::isnan(values->heights[i])
                                                 : std::abs(values->heights[i] - expected) <= (text ? 1e-6 : 1e-12))
                    << given.name << ", " << file << ": " << values->heights[i] << " instead of " << expected;
            }
            EXPECT_EQ(values->place, (std::array<double, 6>{1000, 10, 0, 2000, 0, -10})) << given.name << file;
            const std::string system = given.system == nullptr ? "" : given.system;
            EXPECT_EQ(codesOf(file), text ? system.substr(0, system.find('+')) : system) << given.name << file;
        }
    }
}

TEST_F(RoundTrip, CgalReadsAMeshAsItIs) {
    const scene::Mesh mesh{
        {{500000.125, 5200000, 1.5}, {500010, 5200000.25, -2}, {500010, 5200010, 1e-9}, {500000, 5200010, 7}},
        {{0, 1, 2}, {0, 2, 3}}};
    scene::writeMesh(mesh, path("m.ply"));
    std::ifstream stream(path("m.ply"), std::ios::binary);
    std::vector<CGAL::Simple_cartesian<double>::Point_3> points;
    std::vector<std::vector<std::size_t>> faces;
    ASSERT_TRUE(CGAL::IO::read_PLY(stream, points, faces));
    ASSERT_EQ(points.size(), mesh.vertices.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_EQ(points[i][axis], mesh.vertices[i].at(static_cast<std::size_t>(axis))) << i;
        }
    }
    ASSERT_EQ(faces.size(), mesh.triangles.size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
        EXPECT_EQ(faces[i], std::vector<std::size_t>(mesh.triangles[i].begin(), mesh.triangles[i].end())) << i;
    }
}

}  // namespace
