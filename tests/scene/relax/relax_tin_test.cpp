// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "base/input_error.hpp"
#include "scene/relax/tin_sand.hpp"
#include "tests/scene/relax/relax_tin_fixture.hpp"

namespace {

TEST_F(RelaxTin, SettlesStopsAndWritesBothKindsOfFile) {
    writePoints("in.csv", survey(24, 64, [](double x, double) { return x < 12 ? 20.0 : 0.0; }));
    const auto settled = relax("in.csv out.ply --talus 33 --scheme settle");
    EXPECT_EQ(settled["at_rest"], true);
    EXPECT_EQ(settled["volume_after"], settled["volume_before"]);
    EXPECT_LE(settled["too_steep_area"], 0.001);
    const std::string ply = read("out.ply");
    EXPECT_EQ(ply.rfind("ply\nformat binary_little_endian 1.0\nelement vertex 580\n", 0), 0U) << ply.substr(0, 60);
    const auto stopped = relax("in.csv out.obj --talus 33 --sweeps 7");
    EXPECT_EQ(stopped["sweeps"], 7);
    EXPECT_EQ(stopped["at_rest"], false);
    EXPECT_EQ(stopped["volume_after"], stopped["volume_before"]);
    EXPECT_EQ(relax("in.csv again.obj --talus 33 --sweeps 7")["state_hash"], stopped["state_hash"]);
    EXPECT_EQ(read("again.obj"), read("out.obj"));
}

TEST_F(RelaxTin, EndingsInLargeLettersMeanTheSame) {
    writePoints("IN.CSV", survey(8, 65, [](double x, double) { return x < 4 ? 20.0 : 0.0; }));
    (void)relax("IN.CSV out.obj --talus 33");
    (void)relax("IN.CSV out.ply --talus 33");
    (void)relax("IN.CSV OUT.OBJ --talus 33");
    (void)relax("IN.CSV OUT.Ply --talus 33");
    EXPECT_EQ(read("OUT.OBJ"), read("out.obj"));
    EXPECT_EQ(read("OUT.Ply"), read("out.ply"));
    EXPECT_EQ(read("OUT.Ply").substr(0, 4), "ply\n");
}

TEST_F(RelaxTin, ARasterBecomesTheMeshThatItsErrorAllows) {
    std::vector<double> heights;
    heights.reserve(std::size_t{48} * 40);
    for (int row = 0; row < 40; ++row) {
        for (int column = 0; column < 48; ++column) {
            heights.push_back(8 * std::sin(column * 0.3) * std::cos(row * 0.2));
        }
    }
    scene::writeEsriGrid({48, 40, 3, kWest, kSouth, heights}, path("in.asc"));
    const auto json = relax("in.asc out.obj --talus 80 --max-error 0.25");
    EXPECT_LE(json["max_error"], 0.25);
    EXPECT_GT(json["max_error"], 0.0);
    EXPECT_LT(json["rms_error"], json["max_error"]);
    EXPECT_LT(json["vertices"], 48 * 40 / 2);
    const scene::Mesh mesh = readObj("out.obj");
    const std::set<double> known(heights.begin(), heights.end());
    double east = 0;
    for (const auto& [x, y, z] : mesh.vertices) {
        EXPECT_TRUE(known.contains(z)) << z << ": nothing is as steep as 80 degrees";
        east = std::max(east, x);
    }
    EXPECT_EQ(east, kWest + 47.5 * 3) << "to the middles of the outermost cells";
    EXPECT_EQ(relax("in.asc out.obj --talus 80 --vertices 100")["vertices"], 100);
}

TEST_F(RelaxTin, CellsThatAreNotSquareKeepTheirShape) {
    write("in.asc", "ncols 3\nnrows 2\nxllcorner 10\nyllcorner 20\ndx 3\ndy 1\n1 7 3\n4 5 60\n");
    (void)relax("in.asc out.obj --talus 89.9 --max-error 0");
    const scene::Mesh mesh = readObj("out.obj");
    std::set<std::array<double, 3>> vertices(mesh.vertices.begin(), mesh.vertices.end());
    EXPECT_EQ(
        vertices,
        (std::set<std::array<double, 3>>{
            {11.5, 20.5, 4}, {14.5, 20.5, 5}, {17.5, 20.5, 60}, {11.5, 21.5, 1}, {14.5, 21.5, 7}, {17.5, 21.5, 3}}));
}

TEST_F(RelaxTin, BadPointsAreOneLine) {
    expectPointsRefused("", "holds 0 points at different places, but terrain needs at least 3");
    expectPointsRefused("x,y,z\n1,2,3\n", "holds 1 points");
    expectPointsRefused("0,0,1\n1,1,2\n2,2,3\n", "all 3 points lie on one line");
    expectPointsRefused("0,0,1\n1,0,2\n0,1,3\n1,0,4\n", "bad.csv:4: x = 1, y = 0 has height 4, and 2 in line 2");
    expectPointsRefused("0,0,1\n1,0,nan\n0,1,3\n", "bad.csv:2: z must be a finite number, got 'nan'");
    expectPointsRefused("0,0,1\n1,0\n", "bad.csv:2: expected x, y and z, got 2 values");
    expectPointsRefused("0 0 1\n1e6 0.1 2\n1e6 0 3\n", "all points lie in a strip 1000000 long and 0.1 wide");
    expectPointsRefused("0 0 1\n1 0 2\n0 1 1e6\n", "span more than a TIN of this extent can hold");
    expectPointsRefused("0 0 1\n1 0 -1e308\n0 1 1e308\n", "span more than a TIN of this extent can hold");
    expectPointsRefused("0 0 1\n1e160 0 2\n0 1e160 3\n",
                        "bad.csv: it is 1e+160 long, which cannot be a length of terrain");
    expectPointsRefused("0 0 1\n1e-200 0 2\n0 1e-200 3\n",
                        "bad.csv: it is 1e-200 long, which cannot be a length of terrain");
    expectPointsRefused("0 0 1\n1e-155 0 2\n0 1e-155 3\n", "which cannot be a length of terrain");
    expectRefused("none.csv out.ply --talus 30", "none.csv: cannot be read");
    EXPECT_THROW((void)scene::relax::toTin(scene::Points((1U << 22U) + 1), "large.csv", {30, 0}), base::InputError);
}

TEST_F(RelaxTin, OptionsThatWouldDoNothingAreRefused) {
    write("in.csv", "0 0 0\n1 0 0\n0 1 1\n");
    write("in.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n");
    expectRefused("in.csv out.asc --talus 30", "OUT must be a mesh, .ply or .obj, where IN holds points");
    expectRefused("in.asc out.asc --talus 30 --vertices 9", "left out unless OUT is a mesh, .ply or .obj");
    expectRefused("in.asc out.ply --talus 30", "in.asc: how finely should a TIN follow it?");
    expectRefused("in.csv out.ply --talus 30 --max-error 1", "left out for points");
    expectRefused("in.csv out.ply --talus 30 --scheme g_plain", "--scheme must be g or settle for a TIN, got g_plain");
    expectRefused("in.csv out.ply --talus 30 --threads 2", "--threads must be left out for a TIN");
    expectRefused("in.csv out.ply --talus 30 --bedrock in.asc", "--bedrock must be left out for a TIN");
    expectRefused("in.asc out.ply --talus 30 --max-error -1", "--max-error must be 0 or more, got -1");
    expectRefused("in.asc out.ply --talus 30 --vertices 3", "--vertices must be within [4, 4194304], got 3");
    expectRefused("in.csv none/out.ply --talus 30", "none/out.ply");
}

TEST_F(RelaxTin, CellsWithoutDataAreAHoleInTheMesh) {
    std::vector<double> heights;
    for (int i = 0; i < 12 * 9; ++i) {
        const int column = i % 12, row = i / 12;
        const bool gap = (column >= 3 && column < 6 && row >= 2 && row < 6) || (column < 2 && row == 0);
        heights.push_back(gap ? std::nan("") : column == 7 && row == 4 ? 40 : 5);
    }
    scene::writeEsriGrid({12, 9, 2, kWest, kSouth, heights}, path("in.asc"));
    const auto json = relax("in.asc out.obj --talus 34 --max-error 0.01");
    EXPECT_EQ(json["volume_before"], json["volume_after"]);
    EXPECT_TRUE(json["at_rest"]);
    EXPECT_GT(json["sweeps"], 10);
    const scene::Mesh mesh = readObj("out.obj");
    double area = 0;
    for (const auto& triangle : mesh.triangles) {
        const auto& [a, b, c] =
            std::array{mesh.vertices.at(triangle[0]), mesh.vertices.at(triangle[1]), mesh.vertices.at(triangle[2])};
        area += 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
        const double x = ((a[0] + b[0] + c[0]) / 3 - kWest) / 2, y = ((a[1] + b[1] + c[1]) / 3 - kSouth) / 2;
        EXPECT_FALSE(x > 3 && x < 6 && y > 3 && y < 7) << x << ", " << y;
    }
    // The area reaches from middle to middle of the outermost cells. The gap in the corner is one and a half cells by
    // half a cell.
    EXPECT_NEAR(area, 4 * (11 * 8 - 3 * 4 - 1.5 * 0.5), 1e-6);
    for (const auto& [x, y, z] : mesh.vertices) {
        EXPECT_GE(z, 5 - 1e-6);
        EXPECT_FALSE(x == kWest + 1 && y == kSouth + 17) << "the field's corner is in a hole";
    }
}

TEST_F(RelaxTin, AGapThatATinCannotHaveIsNamed) {
    write("gap.asc", "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ndx 1\ndy 2\nNODATA_value -1\n1 2 3\n4 -1 5\n6 7 8\n");
    expectRefused("gap.asc out.ply --talus 30 --max-error 0", "column 2 of this row: no data inside a raster of cells");
    write("few.asc", "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -1\n1 2 3\n4 -1 5\n6 7 8\n");
    expectRefused("few.asc out.ply --talus 30 --vertices 5", "the outline of its cells without data takes");
}

TEST_F(RelaxTin, PointsTooNearToBeToldApartAreSaid) {
    write("in.csv", "0 0 0\n1000 0 0\n0 1000 5\n0.0001 1000 6\n");
    const support::Ran ran = run("in.csv out.ply --talus 30");
    EXPECT_EQ(ran.status, 0) << ran.output;
    EXPECT_NE(ran.output.find("sandwall-relax: warning: in.csv: 1 points lie within 0.00192 of another"),
              std::string::npos)
        << ran.output;
    EXPECT_NE(ran.output.find("up to 1 higher or lower"), std::string::npos) << ran.output;
}

}  // namespace
