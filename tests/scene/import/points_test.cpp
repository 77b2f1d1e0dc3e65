// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "scene/import/points_file.hpp"
#include "tests/scene/import/import_fixture.hpp"
#include "tests/support/files/text_forms.hpp"

namespace {

class PointsFile : public Import {
protected:
    [[nodiscard]] scene::Points read(const std::string& text) { return scene::readPoints(write("p.csv", text)); }
    [[nodiscard]] std::string refused(const std::string& text) {
        try {
            (void)read(text);
        } catch (const base::InputError& error) {
            return std::string(error.what()).substr(folder_.string().size() + 1);
        }
        return "accepted";
    }
};

TEST_F(PointsFile, AnySeparatorGivesTheSamePoints) {
    const scene::Points points{{0, 0, 1.5}, {1, 0, -2}, {0, 1, 1e3}};
    EXPECT_EQ(read("0,0,1.5\n1,0,-2\n0,1,1e3\n"), points);
    EXPECT_EQ(read("x,y,z\n0, 0, 1.5\n1, 0, -2\n0, 1, 1e3"), points);
    EXPECT_EQ(read("# a survey\r\n\r\neast;north;height\r\n0;0;1.5\r\n1;0;-2 # a stone\r\n0;1;+1e3\r\n"), points);
    EXPECT_EQ(read("  0 0   1.5\n1\t0\t-2\n0 \t1 1e3\n"), points);
}

TEST_F(PointsFile, WhatIsSaidTwiceComesOnce) {
    EXPECT_EQ(read("0 0 1\n1 0 2\n0 0 1\n0 1 3\n").size(), 3U);
    EXPECT_EQ(refused("0 0 1\n1 0 2\n0 1 3\n0 0 1.5\n"),
              "p.csv:4: x = 0, y = 0 has height 1.5, and 1 in line 1; keep "
              "one of them");
}

TEST_F(PointsFile, ComplaintsNameLineAndValue) {
    EXPECT_EQ(refused("0 0 1\n1 0\n"), "p.csv:2: expected x, y and z, got 2 values");
    EXPECT_EQ(refused("0,0,1\n1,0,2,9\n"), "p.csv:2: expected x, y and z, got 4 values");
    EXPECT_EQ(refused("0,0,1\n1,,2\n"), "p.csv:2: y must be a finite number, got ''");
    EXPECT_EQ(refused("0 0 nan\n"), "p.csv:1: z must be a finite number, got 'nan'");
    EXPECT_EQ(refused("x y z\nx y z\n"), "p.csv:2: x must be a finite number, got 'x'");
    EXPECT_EQ(refused("z,x,y\n1,2,3\n"), "p.csv:1: the columns must be x, y, z, and 'z' is number 1");
    EXPECT_EQ(refused("id,e,n,h\n1,2,3,4\n"),
              "p.csv:1: expected three columns x, y, z, but 'id' begins a title of 4; leave other columns out");
}

TEST_F(PointsFile, TheFirstPointIsNoTitleHoweverItIsWritten) {
    const std::string rest = "1,0,1\n0,1,1\n2,2,3\n";
    EXPECT_EQ(read("\xEF\xBB\xBF"
                   "0,0,100\n" +
                   rest)
                  .size(),
              4U)
        << "a byte-order mark, as spreadsheets write it";
    EXPECT_EQ(refused("nan,0,100\n" + rest), "p.csv:1: x must be a finite number, got 'nan'");
    EXPECT_EQ(refused("-inf,nan,-nan(ind)\n" + rest), "p.csv:1: x must be a finite number, got '-inf'");
    EXPECT_EQ(refused("1e999,0,100\n" + rest), "p.csv:1: x must be a finite number, got '1e999'");
    EXPECT_EQ(refused("1.234.5,0,100\n" + rest), "p.csv:1: x must be a finite number, got '1.234.5'");
    EXPECT_EQ(refused("o,0,100\n" + rest), "p.csv:1: x must be a finite number, got 'o'");
    EXPECT_EQ(refused("\"0\",\"0\",\"100\"\n" + rest), "p.csv:1: x must be a finite number, got '\"0\"'");
    EXPECT_EQ(read("0,5;0,5;100,2\n1;0;1\n0;0;2\n")[0], (std::array<double, 3>{0.5, 0.5, 100.2}));
    EXPECT_EQ(refused(",,\n" + rest), "p.csv:1: x must be a finite number, got ''");
    EXPECT_EQ(refused("\xE2\x88\x92"
                      "5 0 1\n"),
              "p.csv:1: x must be a finite number, got '\xE2\x88\x92"
              "5'");
}

TEST_F(PointsFile, TextIsReadInEveryForm) {
    const scene::Points points{{0, 0, 1.5}, {20, 0, -2}, {0, 10, 3}};
    for (const test::TextForm& form : test::formsOf("x,y,z\n0,0,+1.5\n20,0,-2\n0,10,3\n")) {
        EXPECT_EQ(read(form.bytes), points) << form.name;
    }
}

TEST_F(PointsFile, DecimalCommasAreReadWhereNoCommaSeparates) {
    const scene::Points points{{0.5, 0, 1.5}, {1, 0, -2.25}, {0, 1, 3}};
    EXPECT_EQ(read("x;y;z\n0,5;0;1,5\n1;0;-2,25\n0;1;3\n"), points);
    EXPECT_EQ(read("0,5 0 1,5\n1 0 -2,25\n0 1 3\n"), points);
    EXPECT_EQ(read("0,5\t0\t1,5\n1\t0\t-2,25\n0\t1\t3\n"), points);
    EXPECT_EQ(refused("0,5,0,0,1,5\n"),
              "p.csv:1: expected x, y and z, got 6 values; separate numbers with decimal commas by semicolons");
    EXPECT_EQ(
        refused("0.5;0;1\n1;0;1,500\n"),
        "p.csv:2: '1,500' in line 2 has a decimal comma, and '0.5' in line 1 a decimal point, so that the comma could "
        "separate thousands; write decimal points in all numbers");
}

TEST_F(PointsFile, SeparatorsOfThousandsAreNamed) {
    EXPECT_EQ(refused("x;y;z\n500.000,5;0;1\n"),
              "p.csv:2: x must be a finite number, got '500.000,5'; leave separators of thousands out");
    EXPECT_EQ(refused("x;y;z\n0;5,200,000.5;1\n"),
              "p.csv:2: y must be a finite number, got '5,200,000.5'; leave separators of thousands out");
}

TEST_F(PointsFile, NamesOfColumnsDecideTheirOrder) {
    // The second point is 20 farther east, the third 10 farther north.
    const scene::Points points{{0, 0, 1}, {20, 0, 2}, {0, 10, 3}};
    const std::string eastFirst = "0,0,1\n20,0,2\n0,10,3\n", northFirst = "0,0,1\n0,20,2\n10,0,3\n";
    for (const char* title : {"Easting,Northing,Elevation", "POINT_X,POINT_Y,POINT_Z", "x [m],y [m],z [m]", "E,N,H",
                              "Ost,Nord,H\xF6he", "a,b,c", "east,b,c"}) {
        EXPECT_EQ(read(std::string(title) + '\n' + eastFirst), points) << title;
    }
    for (const char* title : {"Northing,Easting,Elevation", "N,E,Z", "Hochwert,Rechtswert,H\u00f6he", "north,east,c"}) {
        EXPECT_EQ(read(std::string(title) + '\n' + northFirst), points) << title;
    }
    EXPECT_EQ(read("Elevation,Easting,Northing\n1,0,0\n2,20,0\n3,0,10\n"), points);
    for (const char* title : {"POINT_Y,POINT_X,POINT_Z", "y,x,z"}) {
        EXPECT_TRUE(
            refused(std::string(title) + '\n' + northFirst).starts_with("p.csv:1: the columns must be x, y, z, "))
            << title;
    }
    for (const char* title : {"Northing,b,c", "x,east,z", "X (Northing),Y (Easting),Z", "a,Easting,c"}) {
        EXPECT_TRUE(refused(std::string(title) + '\n' + northFirst).starts_with("p.csv:1: the columns '"))
            << refused(std::string(title) + '\n' + northFirst);
    }
    for (const char* title :
         {"Breite;Laenge;Hoehe", "L\u00e4nge;Breite;H\u00f6he", "L\xE4nge;Breite;H", "Latitud;Longitud;z"}) {
        EXPECT_NE(refused(std::string(title) + "\n47.1;10.2;3\n").find(") are degrees, but sand needs lengths"),
                  std::string::npos)
            << title;
    }
}

TEST_F(PointsFile, TitlesAreSkipped) {
    const std::string rest = "1,0,1\n0,1,1\n2,2,3\n";
    for (const char* title : {"x,y,z", "\xEF\xBB\xBFx,y,z", "\"x\",\"y\",\"z\"", "Easting [m],Northing [m],Height [m]",
                              "X1,Y1,nanometres", "Rechtswert,Hochwert,H\xC3\xB6he", "\xEF\xBB\xBF# a survey\nx,y,z"}) {
        EXPECT_EQ(read(std::string(title) + '\n' + rest).size(), 3U) << title;
    }
    EXPECT_EQ(refused("\"z\",\"x\",\"y\"\n" + rest), "p.csv:1: the columns must be x, y, z, and 'z' is number 1");
}

TEST_F(PointsFile, DegreesAreRefusedWithTheCommandThatMakesMetres) {
    const auto said = [](long line, const std::string& column, int epsg) {
        return fmt::format(
            "p.csv:{}: its coordinates ('{}') are degrees, but sand needs lengths; make metres of lines of longitude, "
            "latitude and height: gdaltransform -s_srs EPSG:4326 -t_srs EPSG:{}",
            line, column, epsg);
    };
    EXPECT_EQ(refused("lat,lon,h\n47.1,10.2,1200\n"), said(1, "lat", 32632));
    EXPECT_EQ(refused("# ours\nLon;Lat;z\n-120.2;37;3\n"), said(2, "Lon", 32610));
    EXPECT_EQ(refused("\"Longitude\",\"Latitude\",h\n-43,-22.5,3\n"), said(1, "Longitude", 32723));
    EXPECT_EQ(refused("x [deg],y [deg],z\n10,-88,3\n"), said(1, "x [deg]", 3031));
    EXPECT_EQ(read("x,y,long term height\n1,0,1\n0,1,1\n2,2,3\n").size(), 3U);
}

TEST_F(PointsFile, DegreesAreNamedWhereverTheyStand) {
    for (const std::string value : {"10.2\xC2\xB0", "10\u00B012'06\"", "10.2E", "10.2 W"}) {
        for (const std::string& line : {value + ",47.1,1200\n", "0,0,1\n47.1," + value + ",1200\n"}) {
            const std::string said = refused(line);
            EXPECT_NE(said.find("its coordinates ('" + value + "') are degrees, but sand needs lengths"),
                      std::string::npos)
                << said;
        }
    }
    EXPECT_NE(refused("10.2\xB0,47,3\n").find("('10.2\xC2\xB0') are degrees"), std::string::npos) << "Latin-1";
    EXPECT_EQ(refused("id,lon,lat,h\n1,10.2,47.1,1200\n"),
              "p.csv:1: expected three columns x, y, z, but 'id' begins a title of 4; 'lon' is in degrees, but sand "
              "needs lengths");
    EXPECT_EQ(refused("10.2m,47,3\n"), "p.csv:1: x must be a finite number, got '10.2m'");
    EXPECT_EQ(refused("E,47,3\n"), "p.csv:1: x must be a finite number, got 'E'");
}

TEST_F(PointsFile, CloudsWithoutAnAreaAreNoTerrain) {
    EXPECT_EQ(refused(""), "p.csv: holds 0 points at different places, but terrain needs at least 3");
    EXPECT_EQ(refused("1 1 1\n1 1 1\n2 2 2\n"),
              "p.csv: holds 2 points at different places, but terrain needs at least 3");
    std::string line;
    for (int i = 0; i < 50; ++i) {
        line += fmt::format("{} {} {}\n", 0.1 * i, 0.3 * i + 7, i % 3);
    }
    EXPECT_EQ(refused(line), "p.csv: all 50 points lie on one line, but terrain needs an area");
    EXPECT_EQ(read(line + "0 7.001 1\n").size(), 51U);
}

TEST_F(PointsFile, HugeAndTinyCloudsHaveAnArea) {
    for (const char* side : {"1e160", "1e308", "1e-200", "5e-324"}) {
        const std::string points = fmt::format("0,0,0\n{0},0,0\n0,{0},0\n-{0},-{0},0\n", side);
        EXPECT_EQ(read(points).size(), 4U) << side;
        EXPECT_EQ(refused(fmt::format("0,0,1\n{0},{0},2\n-{0},-{0},3\n", side)),
                  "p.csv: all 3 points lie on one line, but terrain needs an area");
        write("p.csv", points);
        const std::string line = refusal("[terrain]\nkind = \"points\"\nfile = \"p.csv\"\n[tin]\n");
        EXPECT_NE(line.find("s.toml:3: the points are "), std::string::npos) << line;
        EXPECT_NE(line.find(" long, which cannot be a length of terrain"), std::string::npos) << line;
    }
}

TEST_F(Import, DevicesThatNeverEndAreNoTerrain) {
    for (const std::string kind : {"gsf", "points", "esri_ascii", "dem"}) {
        EXPECT_EQ(refusal("[terrain]\nkind = \"" + kind + "\"\nfile = \"/dev/zero\"\n"),
                  "/dev/zero: cannot be read; check the path");
    }
}

TEST_F(PointsFile, AFileThatCannotBeReadToItsEndIsNotTakenForItsBeginning) {
    try {
        (void)scene::readPoints("/proc/self/mem");  // opens, but its first byte cannot be read
        FAIL() << "accepted";
    } catch (const base::InputError& error) {
        EXPECT_STREQ(error.what(), "/proc/self/mem: cannot be read to its end; check the disk it lies on");
    }
}

TEST_F(PointsFile, AFieldOfCellsAsksForATriangulation) {
    write("p.csv", "0 0 1\n1 0 2\n0 1 3\n");
    EXPECT_EQ(refusal("[terrain]\nkind = \"points\"\nfile = \"p.csv\"\n"),
              "s.toml:2: points make a triangulated terrain: add [tin]; or make a raster of them, for kind = \"dem\": "
              "gdal_grid");
}

}  // namespace
