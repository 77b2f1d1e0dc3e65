// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include "scene/export/raster.hpp"
#include "scene/import/gsf_file.hpp"
#include "scene/model/scene.hpp"
#include "tests/scene/import/import_fixture.hpp"

namespace {

const std::string kScan = "[terrain]\nkind = \"gsf\"\nfile = \"t.gsf\"\n";
// A square with a side of 200 nm.
const std::string kHeader =
    "Gwyddion Simple Field 1.0\nXRes = 2\nYRes = 2\nXReal = 2e-07\nYReal = 2e-07\nXYUnits = m\nZUnits = m\n";

std::string scan(std::string text, const std::vector<float>& heights) {
    text.append(4 - text.size() % 4, '\0');
    for (const float height : heights) {
        text.append(reinterpret_cast<const char*>(&height), sizeof height);
    }
    return text;
}

TEST_F(Import, AScanOfNanometresBecomesLargeEnoughToTouch) {
    write("t.gsf", scan(kHeader, {0, 1e-7F, 2e-8F, 5e-8F}));
    const scene::Scene scene = load(kScan);
    ASSERT_EQ(scene.terrain.columns(), 2);
    EXPECT_EQ(scene.terrain.cellSize(), 1) << "two units wide";
    EXPECT_NEAR(scene.terrain.height(1, 1), sand::kUnitsPerCell, 1);
    EXPECT_NEAR(scene.terrain.height(0, 0), sand::kUnitsPerCell / 5.0, 1);
    EXPECT_NEAR(load(kScan + "exaggeration = 10\n").terrain.height(0, 0), 2.0 * sand::kUnitsPerCell, 1);
    EXPECT_NEAR(load(kScan + "width = 20\n").terrain.height(0, 0), sand::kUnitsPerCell / 5.0, 1)
        << "larger, and of the same shape";
    EXPECT_NEAR(scene.georeference.cubicMetres() * 1e21, 1, 1e-9) << "a unit is 100 nm";
}

TEST_F(Import, AScanGoesBackOutInMetres) {
    write("t.gsf", scan(kHeader, {0, 1e-7F, 2e-8F, std::numeric_limits<float>::quiet_NaN()}));
    const scene::Scene scene = load(kScan + "exaggeration = 10\ndatum = 0.5\n");
    const scene::EsriGrid out = scene::heightsOf(scene.terrain, scene);
    EXPECT_NEAR(out.cellSize, 1e-7, 1e-20);
    EXPECT_NEAR(out.at(1, 1), 1e-7, 1e-13);
    EXPECT_NEAR(out.at(0, 0), 2e-8, 1e-13);
    EXPECT_TRUE(out.isNoData(1, 0));
    EXPECT_EQ(out.units.heightName, "m");
}

TEST_F(Import, EveryLengthOfAHeaderIsPadded) {
    for (const char* title : {"", "Title = a\n", "Title = ab\n", "Title = abc\n", "Title = abcd\n"}) {
        write("t.gsf", scan(kHeader + title, {1, 2, 3, 4}));
        EXPECT_EQ(scene::readGsf(path("t.gsf")).heights, (std::vector<double>{1, 2, 3, 4})) << title;
    }
}

TEST_F(Import, ScansThatAreNoneSayWhy) {
    const auto refused = [&](const std::string& bytes) {
        write("t.gsf", bytes);
        return refusal(kScan);
    };
    const std::vector<float> four{1, 2, 3, 4};
    EXPECT_EQ(refused("PNG"), "t.gsf:1: a Gwyddion Simple Field begins with 'Gwyddion Simple Field 1.0'");
    EXPECT_EQ(refused(kHeader), "t.gsf: its header has no end: zeros must come before the numbers");
    EXPECT_EQ(refused(scan(kHeader, {1, 2, 3})), "t.gsf: 2 x 2 pixels are 16 bytes, but 12 follow the header");
    EXPECT_EQ(refused(scan("Gwyddion Simple Field 1.0\nYRes = 1\n", {1})), "t.gsf: its header has no XRes");
    EXPECT_EQ(refused(scan("Gwyddion Simple Field 1.0\nXRes = -4\n", {1})),
              "t.gsf:2: XRes must be a whole number within [1, 16384], got -4");
    EXPECT_EQ(refused(scan(kHeader + "XReal = 0\n", four)), "t.gsf:8: XReal must be positive, got 0");
    EXPECT_EQ(refused(scan(kHeader + "XReal = nan\n", four)), "t.gsf:8: XReal must be a finite number, got 'nan'");
    EXPECT_EQ(refused(scan(kHeader + "XReal = 1e-323\nYReal = 1e-323\n", four)),
              "s.toml:3: t.gsf is too small or too large for heights to be scaled; its XReal is in metres");
    EXPECT_EQ(refused(scan(kHeader + "ZUnits = V\n", four)),
              "t.gsf:8: ZUnits must be m for a scan of heights, got 'V'");
    EXPECT_EQ(refused(scan(kHeader + "what\n", four)), "t.gsf:8: expected 'Name = value', got 'what'");
    EXPECT_EQ(refused(scan(kHeader, {1, 2, std::numeric_limits<float>::infinity(), 4})),
              "t.gsf: the height of pixel 1, 2 (from the north-west) is infinite; mask it in Gwyddion");
    write("t.gsf", scan(kHeader, four));
    EXPECT_EQ(refusal(kScan + "exaggeration = 1e302\n"),
              "s.toml:3: t.gsf is too small or too large for heights to be scaled; its XReal is in metres");
    EXPECT_EQ(refusal(kScan + "exaggeration = 1e-302\nwidth = 1e-20\n"),
              "s.toml:3: t.gsf is too small or too large for heights to be scaled; its XReal is in metres");
    EXPECT_EQ(refused(scan(kHeader + "YReal = 4e-07\n", four)),
              "s.toml:3: t.gsf has cells of 1 x 2; a scene's are square; resample it in Gwyddion: Data Process > Basic "
              "Operations > Resample")
        << "GDAL's tools cannot open it";
}

}  // namespace
