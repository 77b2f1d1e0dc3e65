// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "scene/relax/height_scale.hpp"
#include "tests/scene/relax/relax_fixture.hpp"

namespace {

using scene::relax::HeightScale;

TEST(HeightScale, IsTheFinestThatHoldsTheHeights) {
    EXPECT_EQ(HeightScale::finest(10, 480, 900).bits, 16);
    EXPECT_EQ(HeightScale::finest(1, 0, 8192).bits, 16) << "2^29 units of 2^-16, half of them below the datum";
    EXPECT_EQ(HeightScale::finest(1, 0, 8193).bits, 15);
    EXPECT_EQ(HeightScale::finest(1, -1e6, 1e6).bits, 8);
    EXPECT_LT(HeightScale::finest(1, 0, 1e9).bits, 0);
    EXPECT_LT(HeightScale::finest(1, -1e308, 1e308).bits, 0);
    EXPECT_EQ(HeightScale::finest(0.1, 1e9, 1e9).bits, 16) << "far from 0, and level";
}

TEST(HeightScale, KeepsDistancesWhateverTheDatum) {
    const HeightScale low = HeightScale::finest(3, 1680.25, 1726.5);
    const HeightScale high = HeightScale::finest(3, 1680.25, 1999.75);
    ASSERT_EQ(low.unit, high.unit);
    ASSERT_NE(low.datum, high.datum);
    const std::int32_t shift = low.toUnits(1700) - high.toUnits(1700);
    for (const double height : {1680.25, 1690.1, 1700.0, 1712.345678, 1726.5}) {
        EXPECT_EQ(low.toUnits(height) - high.toUnits(height), shift) << height;
        EXPECT_NEAR(low.toHeight(low.toUnits(height)), height, low.unit * 0.5001) << height;
    }
}

class RelaxInput : public Relax {
protected:
    RelaxInput() { write("in.asc", kGrid + "1 2\n3 4\n"); }

    void expectRefused(const std::string& arguments, const std::string& words) const {
        Relax::expectRefused(arguments, words, "out.asc");
    }
    void expectGridRefused(const std::string& grid, const std::string& words) const {
        write("bad.asc", grid);
        expectRefused("bad.asc out.asc --talus 30", words);
    }

    static inline const std::string kGrid = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -1\n";
};

TEST_F(RelaxInput, OptionsOutOfRangeAreRefusedWithTheirRange) {
    expectRefused("in.asc out.asc", "--talus is required");
    for (const char* talus : {"90", "-0.1"}) {
        expectRefused("in.asc out.asc --talus " + std::string(talus),
                      fmt::format("--talus must be within [0, 90) degrees, got {}", talus));
    }
    expectRefused("in.asc out.asc --talus steep", "--talus");
    expectRefused("in.asc out.asc --talus 30 --band -0.01", "--band must be within [0, 1], got -0.01");
    expectRefused("in.asc out.asc --talus nan", "--talus: must be a finite number, got nan");
    expectRefused("in.asc out.asc --talus 30 --sweeps 0", "--sweeps must be within [1, 2147483647]");
    expectRefused("in.asc out.asc --talus 30 --sweeps 5 --scheme settle", "--sweeps must be left out");
    expectRefused("in.asc out.asc --talus 30 --threads 0", "--threads must be within [1, 256], got 0");
    expectRefused("in.asc out.asc --talus 30 --scheme n4", "--scheme: n4 not in {g,g_plain,settle}");
    expectRefused("in.asc out.asc --talus 30 --speed 3", "--speed");
}

TEST_F(RelaxInput, GridsThatCannotBeSandAreRefusedWithTheirLine) {
    expectRefused("nowhere.asc out.asc --talus 30", "nowhere.asc: cannot be read");
    expectGridRefused("", "bad.asc:1: an ESRI ASCII grid begins with");
    expectGridRefused(kGrid + "1 2\n3 x\n", "bad.asc:8: a height must be a finite number, got 'x'");
    expectGridRefused(kGrid + "-1 -1\n-1 -1\n", "bad.asc: every cell is a no-data cell");
    expectGridRefused(kGrid + "1 2\n-3.4e38 4\n",
                      "bad.asc:8: column 1 of this row: a height of -3.4e+38 is out of "
                      "range: heights may span at most 5.369e+08 (2^29 cells)");
    expectGridRefused("ncols 1\nnrows 2\ndx 1\ndy 1001\n1\n2\n",
                      "bad.asc: cells of 1 x 1001 are too oblong; sides must be within 1 : 1000");
}

// The pixels of a text take 8 bytes each while they are read. If they were read first, the word would be refused.
TEST_F(RelaxInput, ARasterThatDoesNotFitTheMemoryIsRefusedBeforeItsPixelsAreRead) {
    write("bad.asc", "ncols 16384\nnrows 16384\ncellsize 1\n1 word\n");
    for (const char* arguments : {"bad.asc out.asc --talus 30", "in.asc out.asc --talus 30 --bedrock bad.asc",
                                  "bad.asc out.ply --talus 30 --max-error 1"}) {
        const support::Ran ran = run(arguments, "ulimit -v 1000000; ");
        EXPECT_EQ(ran.status, 2) << arguments << ran.output;
        EXPECT_NE(ran.output.find("bad.asc: 16384 x 16384 pixels of a raster need at least 2.0 GiB, and "),
                  std::string::npos)
            << arguments << ran.output;
    }
}

TEST_F(RelaxInput, ATalusWithoutUnitsIsRefusedWithAWayOut) {
    expectRefused("in.asc out.asc --talus 0.001",
                  "in.asc: a talus of 0.001 degrees is 1 height units of 1.526e-05 "
                  "from cell to cell, and 4 is the least, except for 0 degrees");
    expectGridRefused(kGrid + "1 2\n3 4e8\n",
                      "heights from 1 to 400000000 span 4e+08 cells: if some are not terrain, "
                      "make them no-data");
}

TEST_F(RelaxInput, ACoarseTalusWarnsWithTheFigure) {
    const support::Ran coarse = run("in.asc out.asc --talus 3");
    EXPECT_EQ(coarse.status, 0);
    EXPECT_NE(
        coarse.output.find(
            "sandwall-relax: warning: in.asc: a talus of 3 degrees is 3435 height units of 1.526e-05 from cell to "
            "cell: slopes may come to rest 0.66 % too steep\n"),
        std::string::npos)
        << coarse.output;
    (void)relax("in.asc out.asc --talus 3.6");  // 4123 units: no warning
}

TEST_F(RelaxInput, BedrockThatDoesNotMatchIsRefused) {
    const auto refused = [&](const std::string& rock, const std::string& words) {
        write("rock.asc", rock);
        expectRefused("in.asc out.asc --talus 30 --bedrock rock.asc", words);
    };
    refused(kGrid + "0 0\n3.5 0\n",
            "rock.asc:8: column 1 of this row: rock at 3.5 lies above in.asc's height of 3; "
            "rock must not be higher");
    refused(kGrid + "0 0\n0 -1\n", "rock.asc:8: column 2 of this row: no rock under in.asc's height of 4");
    refused("ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n0 0\n",
            "rock.asc: 2 x 1 cells of 1 x 1 from (0, 0), but in.asc: 2 x 2 cells of 1 x 1 from (0, 0): they must be");
    refused("ncols 2\nnrows 2\nxllcorner 7\nyllcorner 0\ncellsize 1\n0 0\n0 0\n", "from (7, 0), but in.asc");
}

/// Returns a slope of 12 x 12 cells: from the corner, each row is `step` higher than the row to the south of it.
std::string slopeAt(const std::string& corner, const std::string& cell, double step) {
    std::string text = "ncols 12\nnrows 12\n" + corner + "\ncellsize " + cell + "\n";
    for (int row = 11; row >= 0; --row) {
        for (int column = 0; column < 12; ++column) {
            // The slope eastwards is as steep as northwards, so that the median slope is that of every face.
            text += fmt::format("{} ", 2400 + step * (row + column));
        }
        text += "\n";
    }
    return text;
}

// A cell of 0.000833 degrees is 93 m long from south to north. A rise of 2 m from cell to cell is a slope of 1.2
// degrees. Taken for a length, the cell makes it a slope of 89.98 degrees, and all of the terrain would slide flat.
TEST_F(RelaxInput, DegreesWithoutACoordinateSystemAreRefusedWithTheCommandThatMakesMetres) {
    const std::string corner = "xllcorner -105.56\nyllcorner 40.09";
    const std::string command =
        "gdalwarp -s_srs EPSG:4326 -t_srs EPSG:32613 -r bilinear in.asc metres.tif; or insist "
        "on lengths with --lengths";
    write("in.asc", slopeAt(corner, "0.000833", 2));
    expectRefused("in.asc out.asc --talus 30", command);
    expectRefused("in.asc out.ply --talus 30 --max-error 1", command);
    expectRefused("points.csv out.ply --talus 30 --lengths", "--lengths");
    EXPECT_EQ(run("in.asc out.asc --talus 30 --lengths --sweeps 1").status, 0) << "the user insists";
}

// tan(80 degrees) = 5.6713. A step of 0.005 on cells of 0.000833 is 80.54 degrees, one of 0.0045 is 79.5 degrees.
TEST_F(RelaxInput, LengthsThatAreNoDegreesAreNotRefused) {
    const auto status = [&](const std::string& corner, const std::string& cell, double step) {
        write("in.asc", slopeAt(corner, cell, step));
        return run("in.asc out.asc --talus 30 --sweeps 1").status;
    };
    EXPECT_EQ(status("xllcorner -105.56\nyllcorner 40.09", "0.000833", 0.005), 2);
    EXPECT_EQ(status("xllcorner -105.56\nyllcorner 40.09", "0.000833", 0.0045), 0) << "the slopes can be real";
    EXPECT_EQ(status("xllcorner 179.995\nyllcorner 40.09", "0.000833", 0.005), 2) << "beyond 180 degrees east";
    EXPECT_EQ(status("xllcorner 254.44\nyllcorner 40.09", "0.000833", 0.005), 2) << "counted from 0 to 360 degrees";
    EXPECT_EQ(status("xllcorner 254.44\nyllcorner 40.09", "0.000833", 0.0045), 0) << "the slopes can be real";
    EXPECT_EQ(status("xllcorner 359.995\nyllcorner 40.09", "0.000833", 0.005), 0) << "beyond 360 degrees";
    EXPECT_EQ(status("xllcorner -180.0004165\nyllcorner 40.09", "0.000833", 0.005), 2) << "half a cell beyond";
    EXPECT_EQ(status("xllcorner 10\nyllcorner 89.9904205", "0.000833", 0.005), 2) << "half a cell beyond the pole";
    EXPECT_EQ(status("xllcorner 10\nyllcorner 89.995", "0.000833", 0.005), 0) << "beyond the pole";
    EXPECT_EQ(status("xllcorner 478000\nyllcorner 4437000", "0.000833", 0.005), 0) << "no place on the globe";
}

TEST_F(RelaxInput, WhatCannotBeWrittenIsFoundOutBeforeTheWork) {
    expectRefused("in.asc nowhere/out.asc --talus 30", "nowhere/out.asc: cannot be written; check path");
    expectRefused("in.asc . --talus 30", ".: cannot be written");
    expectRefused("in.asc /dev/full --talus 20", "/dev/full: cannot be written; check path and free space");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1) << "something was left behind";
}

}  // namespace
