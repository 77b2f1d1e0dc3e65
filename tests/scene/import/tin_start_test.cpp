// SPDX-License-Identifier: Apache-2.0
// The error of the TIN with which a session starts, measured between exported rasters and the terrain's source.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "master/journal/journal.hpp"
#include "sand/replica.hpp"
#include "scene/import/esri_file.hpp"
#include "tests/scene/import/import_fixture.hpp"

namespace {

constexpr int kAcross = 72, kDown = 56;  // [cell]
constexpr unsigned kGroundSeed = 83;

/// Returns ground between 0 and 1 that is smooth in the west and jagged in the east, row by row from the north.
std::vector<double> jaggedGround() {
    std::mt19937 random(kGroundSeed);
    std::vector<double> heights;
    for (int row = 0; row < kDown; ++row) {
        for (int column = 0; column < kAcross; ++column) {
            const double smooth = 0.5 + 0.25 * std::sin(column * 0.21) * std::cos(row * 0.17);
            const double jag = static_cast<double>(random() % 1024) / 1024 - 0.5;
            heights.push_back(smooth + (column > kAcross / 2 ? 0.5 * jag : 0));
        }
    }
    return heights;
}

/// Scenes with a [tin], and the rasters that they are exported to.
class StartOfTin : public Import {
protected:
    /// Returns the raster that sandwall-replay writes of a session without any step.
    [[nodiscard]] scene::EsriGrid exported(const scene::Scene& scene) const {
        sand::Replica replica(scene);
        master::JournalWriter writer(path("s.journal"), scene, "test");
        writer.finish(replica.stepNumber(), replica.stateHash());
        const support::Ran ran =
            support::runProgram("sandwall-replay", path("s.journal") + " --heights " + path("h.asc"));
        EXPECT_EQ(ran.status, 0) << ran.output;
        return scene::readEsriGrid(path("h.asc"));
    }

    [[nodiscard]] static std::vector<std::string> warningsOfVertices(const scene::Scene& scene) {
        std::vector<std::string> warnings;
        std::copy_if(scene.warnings.begin(), scene.warnings.end(), std::back_inserter(warnings),
                     [](const std::string& warning) { return warning.find("vertices") != std::string::npos; });
        return warnings;
    }

    /// Makes a TIN of a terrain at each of several distances `widest` [cell]. Expects that no cell of the raster is
    /// farther from its height than max_error. `heights` are row by row from the north; NaN means no data.
    void expectWithin(const std::string& terrain, const std::vector<double>& heights, double maxError) {
        for (const double widest : {0.0, 1.0, 3.0, 7.0, 16.0, 500.0}) {
            const scene::Scene plain = load(terrain);
            const double cell = plain.terrain.cellSize();
            const scene::Scene scene =
                load(fmt::format("{}\n[tin]\nmax_error = {}\nwidest = {}\n", terrain, maxError, widest * cell));
            ASSERT_NE(scene.tin, nullptr);
            EXPECT_EQ(warningsOfVertices(scene), std::vector<std::string>{});
            const scene::EsriGrid grid = exported(scene);
            ASSERT_EQ(grid.heights.size(), heights.size());
            double worst = 0;
            for (std::size_t i = 0; i < heights.size(); ++i) {
                ASSERT_EQ(std::isnan(grid.heights[i]), std::isnan(heights[i])) << i;
                worst = std::isnan(heights[i]) ? worst : std::max(worst, std::abs(grid.heights[i] - heights[i]));
            }
            // Half a unit for each rounding: of max_error, of the terrain's heights, and of the exported heights. The
            // decimals of the latter add at most a hundredth of a unit.
            const double roundings = 1.51 * cell / sand::kUnitsPerCell;
            EXPECT_LE(worst, maxError + roundings) << "widest " << widest << " cells, seed " << kGroundSeed;
            if (widest != 1) {  // with 1, every cell has a vertex
                EXPECT_GT(worst, maxError / 2) << "the TIN is finer than requested, seed " << kGroundSeed;
            }
        }
    }
};

TEST_F(StartOfTin, IsAsNearToAPictureAsMaxErrorAtEveryWidest) {
    constexpr double kWhite = 65535;
    std::vector<double> pixels, heights;
    for (const double height : jaggedGround()) {
        pixels.push_back(std::floor(height * kWhite + 0.5));
        heights.push_back(0.3 * pixels.back() / kWhite);
    }
    writeRaster("t.png", {.columns = kAcross,
                          .rows = kDown,
                          .heights = pixels,
                          .place = {},
                          .epsg = 0,
                          .type = GDT_UInt16,
                          .driver = "PNG"});
    expectWithin("[terrain]\nkind = \"image\"\nfile = \"t.png\"\nwidth = 2\nlow = 0\nhigh = 0.3\n", heights, 0.004);
}

TEST_F(StartOfTin, IsAsNearToAFormulaAsMaxErrorAtEveryWidest) {
    std::vector<double> heights;
    for (int row = kDown - 1; row >= 0; --row) {
        for (int column = 0; column < kAcross; ++column) {
            const double x = (column + 0.5) / kAcross * 2, y = (row + 0.5) / kDown * 2 * kDown / kAcross;
            heights.push_back(0.1 * std::sin(20 * x * y) + (x + y > 2 ? 0.2 : 0));
        }
    }
    expectWithin(fmt::format("[field]\ncolumns = {}\n[terrain]\nkind = \"function\"\nx = [0, 2]\ny = [0, {}]\n"
                             "z = \"0.1*sin(20*x*y) + (x + y > 2 ? 0.2 : 0)\"\n",
                             kAcross, 2.0 * kDown / kAcross),
                 heights, 0.004);
}

TEST_F(StartOfTin, IsAsNearToADemWithHolesAsMaxErrorAtEveryWidest) {
    std::vector<double> heights;
    for (const double height : jaggedGround()) {
        const auto i = static_cast<int>(heights.size());
        const int column = i % kAcross, row = i / kAcross;
        const bool gap = std::hypot(column - 30, row - 20) < 6 || column + row < 9;
        heights.push_back(gap ? std::numeric_limits<double>::quiet_NaN() : 1200 + 80 * height);
    }
    writeRaster("t.tif", {.columns = kAcross, .rows = kDown, .heights = heights, .type = GDT_Float64});
    expectWithin("[terrain]\nkind = \"dem\"\nfile = \"t.tif\"\ndatum = 1200\n", heights, 0.625);
}

TEST_F(StartOfTin, ThatHasTooFewVerticesForMaxErrorSaysHowFarItIs) {
    writeRaster("t.tif", {.columns = kAcross, .rows = kDown, .heights = jaggedGround(), .type = GDT_Float64});
    const std::string terrain = "[terrain]\nkind = \"dem\"\nfile = \"t.tif\"\n[tin]\nmax_error = 0.01\n";
    EXPECT_EQ(warningsOfVertices(load(terrain)), std::vector<std::string>{});
    const scene::Scene few = load(terrain + "vertices = 300\nwidest = 100\n");
    const std::vector<std::string> warnings = warningsOfVertices(few);
    ASSERT_EQ(warnings.size(), 1U);
    const std::string start = "300 vertices are too few for max_error = 0.01: some cell lies ";
    ASSERT_EQ(warnings[0].substr(0, start.size()), start);
    const double told = std::stod(warnings[0].substr(start.size()));
    const std::vector<double> heights = jaggedGround();
    const scene::EsriGrid grid = exported(few);
    double worst = 0;
    for (std::size_t i = 0; i < heights.size(); ++i) {
        worst = std::max(worst, std::abs(grid.heights[i] - heights[i]));
    }
    EXPECT_NEAR(worst, told, 0.0005 * told + 10.0 / sand::kUnitsPerCell) << "four digits, and roundings of a unit";
}

}  // namespace
