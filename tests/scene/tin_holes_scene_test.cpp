// SPDX-License-Identifier: Apache-2.0
// Scenes of a raster with cells without data, as a TIN and as a grid.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "base/input_error.hpp"
#include "sand/replica.hpp"
#include "sand/tin/geometry/surface_view.hpp"
#include "scene/export/raster.hpp"
#include "scene/export/results.hpp"
#include "scene/export/tin_raster.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/sand/tin/same_session.hpp"
#include "tests/support/files/folder_test.hpp"

namespace {

using sand::Replica;
using sand::Step;

constexpr int kRasterSide = 48;

/// Returns whether a cell has no data: a block of cells, a stair whose cells touch at corners, and a corner of the
/// field.
bool isGap(int column, int row) {
    return (column >= 20 && column < 27 && row >= 18 && row < 31) || (column == row && column >= 32 && column < 40) ||
           column + row < 9;
}

class TinHoleScene : public test::FolderTest {
protected:
    /// Returns ground that rises to the north-east, with a steep heap on it.
    [[nodiscard]] scene::Scene scene(const std::string& more, double heap = 12) const {
        std::ofstream grid(folder_ / "dem.asc");
        grid << fmt::format("ncols {0}\nnrows {0}\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n",
                            kRasterSide);
        for (int row = kRasterSide - 1; row >= 0; --row) {
            for (int column = 0; column < kRasterSide; ++column) {
                const double far = std::hypot(column - 14.0, row - 24.0);
                grid << (isGap(column, row) ? -9999 : 0.05 * column + 0.02 * row + std::max(0.0, heap - 2 * far))
                     << ' ';
            }
            grid << '\n';
        }
        grid.close();
        const std::filesystem::path file = folder_ / "scene.toml";
        std::ofstream(file) << "[terrain]\nkind = \"esri_ascii\"\nfile = \"dem.asc\"\n"
                            << more << "[material]\ntalus_deg = 34\nsettling_time = 0.1\n[tool]\nradius = 2\n";
        return scene::loadScene(file);
    }
};

std::vector<Step> strokes(std::uint32_t seed, int steps) {
    std::mt19937 random(seed);
    const auto below = [&](std::uint32_t most) { return static_cast<std::int32_t>(random() % most); };
    std::vector<Step> all;
    sand::ProbePoint probe{kRasterSide * 128, kRasterSide * 128, 600};
    for (int i = 0; i < steps; ++i) {
        Step step{.epoch = 1, .number = static_cast<std::uint64_t>(i + 1), .engaged = i % 16 < 11, .path = {}};
        for (int points = below(4); points > 0; --points) {
            probe = {std::clamp(probe.x + below(801) - 400, 0, kRasterSide * 256),
                     std::clamp(probe.y + below(801) - 400, 0, kRasterSide * 256), 300 + below(900)};
            step.path.push_back(probe);
        }
        all.push_back(step);
    }
    return all;
}

TEST_F(TinHoleScene, ASessionIsTheSameTwiceFromItsMiddleAndAfterItsSceneTravelled) {
    const scene::Scene start = scene("[tin]\nmax_error = 0.05\n");
    ASSERT_NE(start.tin->holes, nullptr);
    const scene::Scene travelled = scene::Scene::decode(start.encode());
    EXPECT_EQ(travelled.rules, start.rules);
    tin_samples::expectSameSession(start, travelled, strokes(5, 160), 53);
}

TEST_F(TinHoleScene, HolesComeBackWithoutData) {
    const scene::Scene start = scene("[tin]\nmax_error = 0.05\n");
    Replica replica(start);
    for (const Step& step : strokes(9, 40)) {
        replica.apply(step);
    }
    const scene::Scene before = scene::sampledScene(start);
    const sand::HeightField after = scene::sampled(replica, start.tin->holes.get());
    const scene::EsriGrid heights = scene::heightsOf(after, before), change = scene::differenceOf(after, before);
    for (int row = 0; row < kRasterSide; ++row) {
        for (int column = 0; column < kRasterSide; ++column) {
            EXPECT_EQ(heights.isNoData(column, row), isGap(column, row)) << column << ", " << row;
            EXPECT_EQ(change.isNoData(column, row), isGap(column, row)) << column << ", " << row;
        }
    }
    const scene::Mesh mesh = scene::meshOf(replica, start);
    EXPECT_GT(mesh.triangles.size(), 10U);
    for (const auto& triangle : mesh.triangles) {
        const auto& a = mesh.vertices[triangle[0]];
        const auto& b = mesh.vertices[triangle[1]];
        const auto& c = mesh.vertices[triangle[2]];
        EXPECT_FALSE(isGap(static_cast<int>((a[0] + b[0] + c[0]) / 3), static_cast<int>((a[1] + b[1] + c[1]) / 3)));
    }
}

// The heap slides down to the block of cells without data, and around it, on both. The grid has walls there, so that
// only sweeps move it. Measured: at most 0.467 cells, 0.041 RMS. The bounds are a tenth larger.
TEST_F(TinHoleScene, TheSamePileOnGridAndTinAgrees) {
    const scene::Scene asGrid = scene("settle = true\n"), asTin = scene("settle = true\n[tin]\nmax_error = 0\n");
    const Replica tin(asTin);
    const sand::HeightField there = scene::sampled(tin, asTin.tin->holes.get());
    double worst = 0, sum = 0;
    int count = 0;
    for (int row = 0; row < kRasterSide; ++row) {
        for (int column = 0; column < kRasterSide; ++column) {
            ASSERT_EQ(asGrid.ground->isWall(column, row), isGap(column, row));
            if (!isGap(column, row)) {
                const double off = std::abs(there.height(column, row) - asGrid.terrain.height(column, row)) / 65536.0;
                worst = std::max(worst, off);
                sum += off * off;
                ++count;
            }
        }
    }
    fmt::print("grid and TIN: {:.3f} cells at most, {:.3f} RMS\n", worst, std::sqrt(sum / count));
    EXPECT_LT(worst, 0.51);
    EXPECT_LT(std::sqrt(sum / count), 0.045);
}

TEST_F(TinHoleScene, AnOutlineOfMoreVerticesThanMayBeIsRefusedInOneLine) {
    try {
        (void)scene("[tin]\nvertices = 20\n");
        FAIL() << "not refused";
    } catch (const base::InputError& error) {
        const std::string said = error.what();
        EXPECT_NE(said.find("the outline of cells without data takes"), std::string::npos) << said;
        EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    }
}

}  // namespace
