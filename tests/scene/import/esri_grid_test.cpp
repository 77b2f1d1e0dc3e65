// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>
#include <limits>

#include "base/input_error.hpp"
#include "host/whole_file.hpp"
#include "scene/import/esri_file.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/files/text_forms.hpp"

namespace {

using scene::EsriGrid;

class EsriFile : public test::FolderTest {
protected:
    [[nodiscard]] std::filesystem::path file() const { return folder_ / "t.asc"; }
    [[nodiscard]] EsriGrid read(const std::string& text) const {
        std::ofstream(file()) << text;
        return scene::readEsriGrid(file());
    }
    [[nodiscard]] std::string complaint(const std::string& text) const {
        try {
            (void)scene::withoutEmptyEdges(read(text));
        } catch (const base::InputError& error) {
            const std::string line = error.what();
            return line.substr(line.find("t.asc"));
        }
        return "no complaint";
    }
    [[nodiscard]] std::string text() const {
        std::ifstream stream(file());
        return {std::istreambuf_iterator<char>(stream), {}};
    }
};

TEST_F(EsriFile, ComesBackCharacterForCharacter) {
    const std::string text =
        "ncols 3\nnrows 2\nxllcorner 361015.59563119\nyllcorner -6\ncellsize 0.1\nNODATA_value -9999\n"
        "1 2.25 -9999\n482.1234436035156 1e+20 -0.001\n";
    scene::writeEsriGrid(read(text), file());
    EXPECT_EQ(this->text(), text);
}

TEST_F(EsriFile, ComesBackWithCellsThatAreNotSquare) {
    const std::string text = "ncols 1\nnrows 2\nxllcorner 0\nyllcorner 0\ndx 2\ndy 0.5\nNODATA_value nan\nnan\n7\n";
    const EsriGrid grid = read(text);
    EXPECT_EQ(grid.aspect(), 0.25);
    EXPECT_TRUE(grid.isNoData(0, 1));
    EXPECT_FALSE(grid.isNoData(0, 0));
    scene::writeEsriGrid(grid, file());
    EXPECT_EQ(this->text(), text);
}

TEST_F(EsriFile, IsReadInEveryFormOfText) {
    const std::string text = "ncols 2\nnrows 1\nxllcorner +10\nyllcorner -3\ncellsize 1\n+1.5 -2\n";
    for (const test::TextForm& form : test::formsOf(text)) {
        const EsriGrid grid = read(form.bytes);
        EXPECT_EQ(grid.heights, (std::vector<double>{1.5, -2})) << form.name;
        EXPECT_EQ(grid.westEdge, 10) << form.name;
        EXPECT_TRUE(scene::holdsEsriGrid(file())) << form.name;
    }
    EXPECT_EQ(complaint("ncols 2\nnrows 1\ncellsize 1\n1\n\0022\n"),
              "t.asc:5: a height must be a finite number, got '?2'");
    EXPECT_TRUE(complaint(std::string("ncols 2\nnrows 1\ncellsize 1\n1\n\0 2\n", 33)).starts_with("t.asc:5: a byte 0"));
    EXPECT_EQ(complaint("ncols 2\nnrows 1\ncellsize 1\n1,5 2\n"),
              "t.asc:4: a height must be a finite number, got '1,5'; write a decimal point");
}

TEST_F(EsriFile, MayGiveTheCornerOfOneAxisAndTheCentreOfTheOther) {
    // Half a cell is 5 from west to east, and 2 from south to north.
    const auto place = [&](const std::string& keys) {
        const EsriGrid grid = read("ncols 1\nnrows 1\n" + keys + "\ndx 10\ndy 4\n7\n");
        return std::array<double, 2>{grid.westEdge, grid.southEdge};
    };
    EXPECT_EQ(place("xllcorner 100\nyllcorner 200"), (std::array<double, 2>{100, 200}));
    EXPECT_EQ(place("xllcenter 100\nyllcenter 200"), (std::array<double, 2>{95, 198}));
    EXPECT_EQ(place("xllcorner 100\nyllcenter 200"), (std::array<double, 2>{100, 198}));
    EXPECT_EQ(place("xllcenter 100\nyllcorner 200"), (std::array<double, 2>{95, 200}));
}

TEST_F(EsriFile, ComparesNoDataAsProgramsPrintIt) {
    const auto noData = [&](const std::string& declared, const std::string& cell) {
        return read("ncols 2\nnrows 1\ncellsize 1\nNODATA_value " + declared + "\n7 " + cell + "\n").isNoData(1, 0);
    };
    // The 32-bit float that is nearest to -9999.9 is -9999.900390625, and the next one -9999.8994140625.
    EXPECT_TRUE(noData("-9999.9", "-9999.900391"));
    EXPECT_FALSE(noData("-9999.9", "-9999.8994140625"));
    // 2^24 + 1 is rounded to the 32-bit float 2^24.
    EXPECT_TRUE(noData("16777216", "16777217"));
    EXPECT_FALSE(noData("16777216", "16777218"));
    EXPECT_TRUE(noData("-3.40282e+38", "-3.402823466e+38")) << "the lowest float with few and with many digits";
    EXPECT_EQ(
        complaint("ncols 1\nnrows 1\ncellsize 1\nNODATA_value -3.40282e+38\n3.402823466e+38\n"),
        "t.asc: 1 cell has the height 3.402823466e+38, which means no data; declare it: add the line 'NODATA_value "
        "3.402823466e+38' to the header");
    EXPECT_FALSE(noData("1e300", "1e299")) << "both would be the float infinity";
    EXPECT_TRUE(noData("1e300", "1e300"));
    for (const char* nan : {"nan", "-nan", "NaN", "1.#QNAN", "nan(ind)"}) {
        EXPECT_TRUE(noData(nan, nan)) << nan;
        EXPECT_TRUE(noData("nan", nan)) << nan;
    }
}

TEST_F(EsriFile, KeepsItsOwnNoDataAndWritesNoneThatItHasNot) {
    EXPECT_EQ(read("ncols 2\nnrows 1\ncellsize 1\n5 -9999\n").at(1, 0), -9999);
    const EsriGrid grid = read("ncols 2\nnrows 1\ncellsize 1\nnodata_value 0\n5 0\n");
    EXPECT_TRUE(grid.isNoData(1, 0));
    scene::writeEsriGrid({2, 1, 1, 0, 0, {5, -9999}}, file());
    EXPECT_EQ(text().find("NODATA"), std::string::npos) << "the second cell would be lost";
    scene::writeEsriGrid({2, 1, 1, 0, 0, {5, std::numeric_limits<double>::quiet_NaN()}}, file());
    EXPECT_TRUE(scene::readEsriGrid(file()).isNoData(1, 0));
}

TEST_F(EsriFile, CentresAreHalfACellFromCorners) {
    const EsriGrid grid = read("ncols 1\nnrows 1\nxllcenter 10\nyllcenter 20\ndx 2\ndy 6\n1\n");
    EXPECT_EQ(grid.westEdge, 9);
    EXPECT_EQ(grid.southEdge, 17);
}

TEST_F(EsriFile, EdgesWithoutDataCanBeCutOff) {
    const EsriGrid grid = scene::withoutEmptyEdges(
        read("ncols 5\nnrows 4\nxllcorner 100\nyllcorner 200\ncellsize 10\nNODATA_value -9999\n"
             "-9999 -9999 -9999 -9999 -9999\n-9999 1 2 3 -9999\n-9999 4 -9999 5 -9999\n"
             "-9999 -9999 -9999 -9999 -9999\n"));
    EXPECT_EQ(grid.columns, 3);
    EXPECT_EQ(grid.rows, 2);
    EXPECT_EQ(grid.westEdge, 110);
    EXPECT_EQ(grid.southEdge, 210);
    EXPECT_EQ(grid.lines, (std::vector<long>{8, 9}));
    EXPECT_EQ(grid.at(0, 0), 4);
    EXPECT_TRUE(grid.isNoData(1, 0)) << "amid others it stays";
    EXPECT_EQ(grid.at(2, 1), 3);
}

TEST_F(EsriFile, ComplaintsNameTheLine) {
    const std::string head = "ncols 2\nnrows 2\ncellsize 1\n";
    EXPECT_EQ(complaint(head + "1 2\n3\n"), "t.asc:6: the file ends where a height should be");
    EXPECT_EQ(complaint(head + "1 2\n3 nan\n"), "t.asc:5: a height must be a finite number, got 'nan'");
    EXPECT_EQ(complaint(head + "1 2\n3 4,5\n"),
              "t.asc:5: a height must be a finite number, got '4,5'; write a decimal point");
    EXPECT_EQ(complaint(head + "1 2\n3 4 5\n"), "t.asc:5: more values than ncols x nrows = 4");
    EXPECT_EQ(complaint("ncols 0\n"), "t.asc:1: ncols must be a whole number within [1, 16384], got 0");
    EXPECT_EQ(complaint("cellsize 0\n"), "t.asc:1: cellsize must be positive, got 0");
    EXPECT_EQ(complaint("depth 3\n"), "t.asc:1: 'depth' is not a key of an ESRI ASCII grid");
    EXPECT_EQ(complaint("nodata_value -1\n" + head + "-1 -1\n-1 -1\n"),
              "t.asc: every cell is a no-data cell; there is no terrain in it");
    for (const char* cells : {"", "dx 1\n", "dy 1\n", "cellsize 1\ndy 1\n", "cellsize 1\ndx 1\ndy 1\n"}) {
        const std::string line = complaint(std::string("ncols 1\nnrows 1\n") + cells + "5\n");
        EXPECT_NE(line.find("either cellsize or dx and dy"), std::string::npos) << cells << line;
    }
}

TEST_F(EsriFile, FewDecimalsStillTellAHeightFromTheNextUnit) {
    for (const double unit : {10.0 / 65536, 1.0 / 3, 0.2, 1.0, 1000.0, 1e-9}) {
        for (const double height : {0.0, 1.0 / 3, -482.123456789, 12345.678}) {
            EXPECT_LE(std::abs(scene::withFewDecimals(height, unit) - height), unit / 100) << height << ", " << unit;
        }
    }
    EXPECT_EQ(scene::withFewDecimals(482.1234567891, 10.0 / 65536), 482.123457);
    EXPECT_EQ(scene::withFewDecimals(1e300, 1e-300), 1e300);
}

TEST_F(EsriFile, WhatCannotBeWrittenLeavesWhatWasThere) {
    std::ofstream(file()) << "old";
    {
        host::WholeFile whole(file());
        whole.stream() << "half of the";
    }
    EXPECT_EQ(text(), "old");
    host::WholeFile whole(file());
    whole.stream() << "new";
    EXPECT_EQ(text(), "old");
    whole.keep();
    EXPECT_EQ(text(), "new");
    EXPECT_THROW(host::WholeFile(folder_ / "nowhere" / "t.asc"), base::InputError);
    EXPECT_THROW(host::WholeFile{folder_}, base::InputError);
    const EsriGrid grid = read("ncols 1\nnrows 1\ncellsize 1\n5\n");
    EXPECT_THROW(scene::writeEsriGrid(grid, "/dev/full"), base::InputError);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1) << "something was left beside it";
}

}  // namespace
