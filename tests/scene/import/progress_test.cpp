// SPDX-License-Identifier: Apache-2.0
// Every source of terrain reports how far its reading is. The haptic server answers waiting masters with it.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "tests/scene/import/import_fixture.hpp"

namespace {

class SceneProgress : public Import {
protected:
    /// Returns the shares that a scene of this terrain reports while it is read.
    [[nodiscard]] std::vector<double> sharesOf(const std::string& terrain) {
        std::vector<double> shares;
        const std::string file = write("s.toml", text(terrain));
        (void)scene::loadScene(file, {.progress = [&](double share) { shares.push_back(share); }});
        return shares;
    }
    /// Expects shares from 0 to 1 in ascending order, at most `longest` apart.
    void expectSteps(const std::string& terrain, double longest) {
        const std::vector<double> shares = sharesOf(terrain);
        ASSERT_FALSE(shares.empty()) << terrain;
        EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end())) << terrain;
        EXPECT_GE(shares.front(), 0) << terrain;
        EXPECT_LE(shares.back(), 1) << terrain;
        double last = 0, most = 0;
        for (const double share : shares) {
            most = std::max(most, share - last);
            last = share;
        }
        EXPECT_LE(std::max(most, 1 - last), longest) << terrain << fmt::format(", {} shares", shares.size());
    }
};

constexpr int kShortSide = 100;

TEST_F(SceneProgress, IsReportedForEachRowOfARasterAScanAPictureAndAFunction) {
    const std::vector<double> heights(kShortSide * kShortSide, 7);
    writeRaster("t.png", {.columns = kShortSide,
                          .rows = kShortSide,
                          .heights = heights,
                          .place = {},
                          .epsg = 0,
                          .type = GDT_Byte,
                          .driver = "PNG"});
    std::string scan = fmt::format("Gwyddion Simple Field 1.0\nXRes = {0}\nYRes = {0}\n", kShortSide);
    scan.append(4 - scan.size() % 4, '\0');
    write("t.gsf", scan + std::string(sizeof(float) * kShortSide * kShortSide, '\0'));
    std::string grid = fmt::format("ncols {0}\nnrows {0}\ncellsize 1\n", kShortSide);
    for (int i = 0; i < kShortSide * kShortSide; ++i) {
        grid += "0 ";
    }
    write("t.asc", grid);
    const double row = 0.6 / kShortSide + 1e-9;  // reading the pixels is 0.6 of the work
    expectSteps("[terrain]\nkind = \"image\"\nhigh = 1\nfile = \"t.png\"", row);
    expectSteps("[terrain]\nkind = \"gsf\"\nfile = \"t.gsf\"", row);
    expectSteps("[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\"", row);
    expectSteps(fmt::format("[field]\ncolumns = {}\n[terrain]\nkind = \"function\"\nx = [0, 1]\ny = [0, 1]\nz = \"x\"",
                            kShortSide),
                row);
    expectSteps("[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\"\nbedrock = \"t.asc\"", row);
}

// GDAL reads stripes of 2^20 pixels: 64 rows here.
TEST_F(SceneProgress, IsReportedForEachStripeOfARaster) {
    constexpr int kLong = 16384, kLongRows = 640;
    writeRaster("t.tif",
                {.columns = kLong, .rows = kLongRows, .heights = {}, .type = GDT_Byte, .options = {"SPARSE_OK=TRUE"}});
    std::vector<double> shares;
    const std::string file = write("s.toml", text("[terrain]\nkind = \"dem\"\nfile = \"t.tif\""));
    (void)scene::loadScene(file, {.progress = [&](double share) { shares.push_back(share); }});
    ASSERT_GE(shares.size(), 10U);
    for (std::size_t i = 0; i < 10; ++i) {
        EXPECT_NEAR(shares[i], 0.06 * static_cast<double>(i + 1), 1e-9);
    }
}

// The file of points has several of the pieces that are read at once, and the mesh several thousand vertices.
TEST_F(SceneProgress, IsReportedForPointsAndTheirTin) {
    std::string points;
    constexpr int kPointsAcross = 200;
    for (int y = 0; y < kPointsAcross; ++y) {
        for (int x = 0; x < kPointsAcross; ++x) {
            points += fmt::format("{}.125,{}.125,{}\n", x, y, (x * 7 + y * 3) % 5);
        }
    }
    write("p.csv", points);
    expectSteps("[terrain]\nkind = \"points\"\nfile = \"p.csv\"\n[tin]\n", 0.3);
}

TEST_F(SceneProgress, IsReportedForTheVerticesThatATinChooses) {
    const std::string dunes = "[field]\ncolumns = 128\n[terrain]\nkind = \"dunes\"\n[tin]\nmax_error = 0\n";
    const std::vector<double> shares = sharesOf(dunes + "vertices = 4096\n");
    EXPECT_GE(shares.size(), 8U);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_LE(shares.back(), 1);
}

}  // namespace
