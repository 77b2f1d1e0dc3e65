// SPDX-License-Identifier: Apache-2.0
// A hand feels on a TIN what it feels on cells.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "sand/force/force_model.hpp"
#include "sand/force/law.hpp"
#include "sand/force/tool_contour.hpp"
#include "sand/replica.hpp"
#include "scene/load/scene_file.hpp"

namespace {

using sand::force::SurfacePatch;

constexpr double kNominal = 0.01;  // [scene unit]

/// Returns level sand of 96 x 96 cells with a tool of eight cells.
scene::Scene sceneOf(const std::string& shape, const std::string& tin) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("sandwall-felt-" + std::to_string(getpid()) + ".toml");
    std::ofstream(file) << "[field]\ncolumns = 96\nwidth = 0.96\n[terrain]\nheight = 0.3\n[material]\n"
                        << tin << "[tool]\nshape = \"" << shape << "\"\nradius = 0.08\n";
    scene::Scene scene = scene::loadScene(file);
    std::filesystem::remove(file);
    return scene;
}

/// Returns the force on a tool whose underside is `depth` below the level, after the sand around it has come to rest.
double upward(const std::string& shape, const std::string& tin, sand::ForceLaw law, double depth, double east = 0) {
    const scene::Scene scene = sceneOf(shape, tin);
    sand::Replica replica(scene);
    const auto place = [&](double under) {
        const auto probe = [](double at) { return static_cast<std::int32_t>(std::lround(at / kNominal * 256)); };
        return sand::ProbePoint{probe(0.48 + east), probe(0.48), probe(0.3 - under + 0.08)};
    };
    for (std::uint64_t number = 1; number <= 20; ++number) {
        replica.apply({.epoch = 1,
                       .number = number,
                       .engaged = number > 1,
                       .path = {place(number == 1 ? -0.2 : depth)},
                       .edit = {}});
    }
    sand::ForceConstants constants;
    constants.law = law;
    constants.unitLength = 0.96;
    SurfacePatch patch;
    patch.take(replica.surface(), replica.rules(), replica.cellSize(), replica.probe());
    EXPECT_EQ(patch.facets().empty(), tin.empty());
    const auto tool = sand::force::contourOf(replica.tool(), replica.cellSize());
    const sand::ProbePoint at = replica.probe();
    const double probe = kNominal / 256;
    return respond(constants, patch, tool, {probe * at.x, probe * at.y, probe * at.z}).push.z;
}

/// Row of the table in docs/figures.md [N].
struct Agreement {
    sand::ForceLaw law;
    const char* shape;
    double cells, fine, coarse;  // on cells, and on TINs whose points are one and two cells apart
};
// A ring far outside the outline contains the same sand on both. Control points of an upright tool are in the side of
// its cut. This side is a slope as wide as the distance of cells or points. A height there depends on the exact
// position. A sphere has no such cut.
constexpr std::array kAgreements{Agreement{sand::ForceLaw::repulse, "sphere", 16.59, 16.50, 16.44},
                                 Agreement{sand::ForceLaw::repulse, "circle", 20.23, 20.00, 19.03},
                                 Agreement{sand::ForceLaw::repulse, "ellipse", 16.16, 16.59, 17.04},
                                 Agreement{sand::ForceLaw::repulse, "footprint", 15.53, 15.74, 15.99},
                                 Agreement{sand::ForceLaw::controlPoints, "sphere", 0.40, 0.41, 0.39},
                                 Agreement{sand::ForceLaw::controlPoints, "circle", 0.28, 0.36, 0.38},
                                 Agreement{sand::ForceLaw::controlPoints, "ellipse", 0.28, 0.37, 0.30},
                                 Agreement{sand::ForceLaw::controlPoints, "footprint", 0.18, 0.16, 0.15}};

// The sand is the same everywhere. A figure of the table is exact to half of its last digit, plus a tenth of that digit
// for the number that was rounded.
TEST(FeltTin, AToolThatIsPressedIsHeldAsOnCells) {
    constexpr double kHundredth = 0.006;  // [N]
    for (const auto& [law, name, onCells, onFine, onCoarse] : kAgreements) {
        const std::string shape = name;
        SCOPED_TRACE(shape + (law == sand::ForceLaw::repulse ? ", repulse" : ", control points"));
        double cells = 0, fine = 0, coarse = 0;
        for (const double east : {0.0, 0.5}) {  // [cell]; the outline lies at different places within a cell
            cells += upward(shape, "", law, 0.03, east * kNominal) / 2;
            fine += upward(shape, "[tin]\nspacing = 0.01\n", law, 0.03, east * kNominal) / 2;
            coarse += upward(shape, "[tin]\nspacing = 0.02\n", law, 0.03, east * kNominal) / 2;
        }
        std::printf("%s: %.4f N on cells, %.4f N and %.4f N on a TIN\n", shape.c_str(), cells, fine, coarse);
        EXPECT_NEAR(cells, onCells, kHundredth);
        EXPECT_NEAR(fine, onFine, kHundredth);
        EXPECT_NEAR(coarse, onCoarse, kHundredth);
    }
}

}  // namespace
