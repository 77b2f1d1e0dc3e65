// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <sstream>

#include "base/input_error.hpp"
#include "scene/import/mesh_file.hpp"
#include "scene/relax/tin_sand.hpp"
#include "tests/scene/relax/relax_fixture.hpp"

namespace {

constexpr double kWest = 361015.25, kSouth = 5070223.5;  // somewhere in a UTM zone

/// Runs that read points and rasters and write meshes.
class RelaxTin : public Relax {
protected:
    void writePoints(const std::string& name, const scene::Points& points) const {
        std::string text = "x, y, z\n";
        for (const auto& [x, y, z] : points) {
            text += fmt::format("{}, {}, {}\n", x, y, z);
        }
        write(name, text);
    }
    [[nodiscard]] scene::Mesh readObj(const std::string& name) const {
        scene::Mesh mesh;
        std::istringstream stream(read(name));
        char kind = 0;
        while (stream >> kind) {
            if (kind == 'v') {
                auto& [x, y, z] = mesh.vertices.emplace_back();
                stream >> x >> y >> z;
            } else {
                auto& [a, b, c] = mesh.triangles.emplace_back();
                stream >> a >> b >> c;
                --a, --b, --c;
            }
        }
        return mesh;
    }
    void expectRefused(const std::string& arguments, const std::string& words) const {
        Relax::expectRefused(arguments, words, "out.ply");
    }
    void expectPointsRefused(const std::string& points, const std::string& words) const {
        write("bad.csv", points);
        expectRefused("bad.csv out.ply --talus 30", words);
    }
};

/// Returns one point in the middle half of every cell of 2 m, and the corners of the field. A function gives the
/// heights.
template <class HeightAt>
scene::Points survey(int side, unsigned seed, HeightAt heightAt) {
    std::mt19937 random(seed);
    const auto within = [&] { return 0.25 + static_cast<double>(random() % 512) / 1024; };
    scene::Points points;
    for (const double x : {0.0, 1.0}) {
        for (const double y : {0.0, 1.0}) {
            points.push_back({kWest + 2 * side * x, kSouth + 2 * side * y, heightAt(side * x, side * y)});
        }
    }
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const double east = x + within(), north = y + within();
            points.push_back({kWest + 2 * east, kSouth + 2 * north, heightAt(east, north)});
        }
    }
    return points;
}

/// Returns twice a triangle's area. Coordinates have up to seven digits before the point, and triangles are more than a
/// micrometre high. The rounding of doubles is far less.
double doubledAreaOf(const scene::Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
    const auto &p = mesh.vertices[triangle[0]], &q = mesh.vertices[triangle[1]], &r = mesh.vertices[triangle[2]];
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
}

/// Expects a surface. Every triangle is counter-clockwise. Every edge belongs to two triangles, or to one at the
/// boundary, which is one closed line. Every vertex has a triangle. Such triangles do not overlap.
void expectSurface(const scene::Mesh& mesh) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    std::set<std::uint32_t> used;
    for (const auto& triangle : mesh.triangles) {
        ASSERT_GT(doubledAreaOf(mesh, triangle), 0);
        for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_TRUE(edges.emplace(triangle.at(k), triangle.at((k + 1) % 3)).second)
                << "two triangles have the same directed edge";
            used.insert(triangle.at(k));
        }
    }
    std::map<std::uint32_t, std::uint32_t> boundary;
    for (const auto& [from, to] : edges) {
        if (!edges.contains({to, from})) {
            ASSERT_TRUE(boundary.emplace(from, to).second) << "the boundary touches itself";
        }
    }
    ASSERT_FALSE(boundary.empty());
    std::size_t length = 1;
    for (std::uint32_t at = boundary.begin()->second; at != boundary.begin()->first; at = boundary.at(at)) {
        ++length;
    }
    EXPECT_EQ(length, boundary.size()) << "the boundary consists of several lines";
    EXPECT_EQ(used.size(), mesh.vertices.size());
}

/// docs/relax.md: returns the steepest triangle at rest, divided by the bound of that page.
double steepestOverBound(const scene::Mesh& mesh, const nlohmann::json& line) {
    const double talus = std::tan(line["talus_deg"].get<double>() * std::numbers::pi / 180);
    const double unit = line["unit"], step = line["lattice"];
    double worst = 0;
    for (const auto& triangle : mesh.triangles) {
        const auto &p = mesh.vertices[triangle[0]], &q = mesh.vertices[triangle[1]], &r = mesh.vertices[triangle[2]];
        const double area = doubledAreaOf(mesh, triangle), rise = q[2] - p[2], other = r[2] - p[2];
        const double slope =
            std::hypot(rise * (r[1] - p[1]) - other * (q[1] - p[1]), other * (q[0] - p[0]) - rise * (r[0] - p[0])) /
            area;
        const double sides = std::hypot(q[0] - p[0], q[1] - p[1]) + std::hypot(r[0] - q[0], r[1] - q[1]) +
                             std::hypot(p[0] - r[0], p[1] - r[1]);
        const double narrow = sides / area, off = 0.71 * step * narrow;
        if (off < 1) {
            worst = std::max(worst, slope * (1 - off) / ((1 + 1.0 / 1024) * (talus + unit * narrow)));
        }
    }
    return worst;
}

double volumeOf(const scene::Mesh& mesh) {
    double sum = 0;
    for (const auto& triangle : mesh.triangles) {
        const double area = doubledAreaOf(mesh, triangle);
        EXPECT_GT(area, 0) << "counter-clockwise";
        for (const std::uint32_t corner : triangle) {
            sum += area / 6 * mesh.vertices[corner][2];
        }
    }
    return sum;
}

TEST_F(RelaxTin, PointsSlideToTheTalusWhereTheyLie) {
    constexpr unsigned kSeed = 61;
    const scene::Points points =
        survey(40, kSeed, [](double x, double y) { return 1200.0 + (std::hypot(x - 20, y - 20) < 9 ? 15 : 0); });
    writePoints("in.csv", points);
    const auto json = relax("in.csv out.obj --talus 35");
    EXPECT_EQ(json["volume_after"], json["volume_before"]);
    EXPECT_TRUE(json["volume_before"].is_number_integer());
    EXPECT_EQ(json["at_rest"], true);
    EXPECT_EQ(json["vertices"], points.size());
    EXPECT_EQ(json["corners_added"], 0);
    EXPECT_NEAR(json["volume_above"], 1200.0, json["unit"].get<double>());
    EXPECT_LE(json["too_steep_area"], 0.001) << "seed " << kSeed;
    EXPECT_GT(json["steepest_over_talus"], 0.98) << "a pile lies at its talus";
    EXPECT_FALSE(json.contains("certificate"));

    const scene::Mesh mesh = readObj("out.obj");
    ASSERT_EQ(mesh.vertices.size(), points.size());
    std::set<std::array<double, 2>> places;
    double highest = 0;
    for (const auto& [x, y, z] : points) {
        places.insert({x, y});
    }
    for (const auto& [x, y, z] : mesh.vertices) {
        EXPECT_TRUE(places.contains({x, y})) << x << ", " << y;
        highest = std::max(highest, z);
    }
    EXPECT_LE(highest, 1215);
    EXPECT_GT(highest, 1205);
    // The whole numbers of the report line give the volume under the triangles of the file.
    const double volume = json["volume_after"].get<double>() * json["volume_unit"].get<double>();
    EXPECT_NEAR(volumeOf(mesh) - 1200.0 * 80 * 80, volume, 1e-3 * volume);
}

/// Returns a parcel of 1000 x 600 m, surveyed to the millimetre. Its rim has a point every 10 m, each off by some
/// millimetres along and across. Every square of 20 m has one more point. A hill and a bank are steeper than sand.
scene::Points parcel(unsigned seed, double noise /* [m], standard deviation */) {
    std::mt19937 random(seed);
    const auto chance = [&] { return static_cast<double>(random()) / 4294967296.0; };
    const auto off = [&] {  // nearly Gaussian; the same with every library
        double sum = -6;
        for (int i = 0; i < 12; ++i) {
            sum += chance();
        }
        return noise * sum;
    };
    scene::Points points;
    const auto add = [&](double x, double y) {
        const double height = 200 + (std::hypot(x - 500, y - 300) < 150 ? 25 : 0) + (x < 80 ? 20 : 0) +
                              8 * std::sin(x / 60) * std::cos(y / 45);
        const auto millimetres = [](double metres) { return std::round(1000 * metres) / 1000; };
        points.push_back({millimetres(kWest + x), millimetres(kSouth + y), millimetres(height)});
    };
    for (int i = 0; i <= 100; ++i) {
        add(10 * i + off(), off());
        add(10 * i + off(), 600 + off());
    }
    for (int i = 1; i < 60; ++i) {
        add(off(), 10 * i + off());
        add(1000 + off(), 10 * i + off());
    }
    for (int column = 0; column < 50; ++column) {
        for (int row = 0; row < 30; ++row) {
            const double x = 20 * column + 3 + 14 * chance();
            add(x, 20 * row + 3 + 14 * chance());
        }
    }
    return points;
}

// Without the removal of slivers, one of these surveys had 2 to 21 clockwise triangles. It needed about 3 million
// sweeps to rest, at 1.2 times the talus.
TEST_F(RelaxTin, ASurveyWithMillimetresOfNoiseAlongItsRimIsASurfaceThatRests) {
    for (unsigned seed = 1; seed <= 16; ++seed) {
        const double noise = seed % 4 == 0 ? 0.02 : 0.002;
        SCOPED_TRACE(fmt::format("seed {}, noise {}", seed, noise));
        const scene::Points points = parcel(seed, noise);
        writePoints("in.csv", points);
        const auto json = relax(std::string("in.csv out.obj --talus 34") + (seed % 2 == 0 ? " --scheme settle" : ""));
        const scene::Mesh mesh = readObj("out.obj");
        expectSurface(mesh);
        EXPECT_EQ(json["at_rest"], true);
        EXPECT_EQ(json["volume_after"], json["volume_before"]);
        EXPECT_EQ(json["places_moved"], 0);
        std::set<std::array<double, 2>> read, written;
        for (const auto& [x, y, z] : points) {
            read.insert({x, y});
        }
        for (const auto& [x, y, z] : mesh.vertices) {
            written.insert({x, y});
        }
        EXPECT_TRUE(std::includes(written.begin(), written.end(), read.begin(), read.end())) << "a point is missing";
        EXPECT_LE(written.size() - read.size(), 4U) << "corners of the rectangle";
        EXPECT_LE(steepestOverBound(mesh, json), 1);
        // The excess is a part in 1024, and places are off by at most 1.4 mm in triangles that are a metre high.
        EXPECT_LE(json["steepest_over_talus"], (1 + 1.0 / 1024) * (1 + 3 * 0.0014));
        EXPECT_LT(json["sweeps"], 2000);
        // The whole rectangle is terrain, except a strip as wide as the noise.
        double area = 0;
        for (const auto& triangle : mesh.triangles) {
            area += doubledAreaOf(mesh, triangle) / 2;
        }
        EXPECT_NEAR(area, 1000.0 * 600, 8 * noise * 2 * (1000 + 600));
    }
}

TEST_F(RelaxTin, PointsNearerThanTheLatticeTellsTheirPlacesKeepTrianglesCounterClockwise) {
    int moved = 0;
    for (unsigned seed = 1; seed <= 8; ++seed) {
        SCOPED_TRACE(fmt::format("seed {}", seed));
        std::mt19937 random(seed);
        const auto below = [&](int most) { return static_cast<int>(random() % static_cast<unsigned>(most)); };
        std::set<std::array<int, 2>> places{{0, 0}, {1000000, 0}, {0, 600000}, {1000000, 600000}};  // [mm]
        for (int i = 0; i < 400; ++i) {
            const std::array<int, 2> place{3000 + below(994000), 3000 + below(594000)};
            places.insert(place);
            places.insert({place[0] + below(7) - 3, place[1] + below(7) - 3});
        }
        scene::Points points;
        for (const auto& [x, y] : places) {
            points.push_back({kWest + x / 1000.0, kSouth + y / 1000.0, std::hypot(x - 500000, y - 300000) / 5000});
        }
        writePoints("in.csv", points);
        const auto json = relax("in.csv out.obj --talus 34 --sweeps 100");
        const scene::Mesh mesh = readObj("out.obj");
        expectSurface(mesh);
        std::set<std::array<double, 2>> read;
        for (const auto& [x, y, z] : points) {
            read.insert({x, y});
        }
        int elsewhere = 0;
        for (const auto& [x, y, z] : mesh.vertices) {
            elsewhere += read.contains({x, y}) ? 0 : 1;
        }
        EXPECT_EQ(json["places_moved"], elsewhere);
        moved += elsewhere;
    }
    EXPECT_GT(moved, 0) << "no point was moved, so that this test proves nothing";
}

/// Returns the height of a grid at (x, y), linear between the middles of four cells.
double between(const scene::EsriGrid& grid, double x, double y) {
    const double east = std::clamp((x - grid.westEdge) / grid.cellSize - 0.5, 0.0, grid.columns - 1.001);
    const double north = std::clamp((y - grid.southEdge) / grid.cellSize - 0.5, 0.0, grid.rows - 1.001);
    const int column = static_cast<int>(east), row = static_cast<int>(north);
    return std::lerp(std::lerp(grid.at(column, row), grid.at(column + 1, row), east - column),
                     std::lerp(grid.at(column, row + 1), grid.at(column + 1, row + 1), east - column), north - row);
}

TEST_F(RelaxTin, ATinAndAGridOfTheSamePileAgree) {
    constexpr unsigned kSeed = 62;
    const auto pile = [](double x, double y) { return std::hypot(x - 20, y - 20) < 9 ? 15.0 : 0.0; };
    writePoints("in.csv", survey(40, kSeed, pile));
    (void)relax("in.csv out.obj --talus 35");
    std::vector<double> heights;
    for (int row = 39; row >= 0; --row) {
        for (int column = 0; column < 40; ++column) {
            heights.push_back(pile(column + 0.5, row + 0.5));
        }
    }
    scene::writeEsriGrid({40, 40, 2, kWest, kSouth, heights}, path("in.asc"));
    (void)relax("in.asc out.asc --talus 35");
    const scene::EsriGrid grid = scene::readEsriGrid(path("out.asc"));
    double off = 0, all = 0;
    for (const auto& [x, y, z] : readObj("out.obj").vertices) {
        off += std::abs(z - between(grid, x, y));
        all += z;
    }
    // Measured: 1.0 % here, and 1.1 to 1.8 % with seven other seeds. The cylinder's jagged edge falls differently on
    // points than on cells: half a cell around 57 causes as much.
    EXPECT_LT(off / all, 0.02) << "seed " << kSeed;
}

TEST_F(RelaxTin, StablePointsComeBackToTheLastDigit) {
    constexpr unsigned kSeed = 63;
    std::mt19937 random(kSeed);
    const scene::Points points = survey(20, kSeed, [&](double x, double y) {
        return 480.123456789 + 0.2 * x + 0.1 * y + static_cast<double>(random() % 1000) / 1e5;
    });
    writePoints("in.xyz", points);
    const auto json = relax("in.xyz out.obj --talus 30");
    EXPECT_EQ(json["at_rest"], true);
    EXPECT_LT(json["steepest_over_talus"], 1.0);
    const std::set<std::array<double, 3>> before(points.begin(), points.end());
    const scene::Mesh mesh = readObj("out.obj");
    EXPECT_EQ(std::set(mesh.vertices.begin(), mesh.vertices.end()), before) << "seed " << kSeed;
}

TEST_F(RelaxTin, CornersWithoutAPointAreAsHighAsTheNearest) {
    write("in.csv", "0 5 1\n10 5 2\n5 0 3\n5 10 4\n5 5 9\n");
    const auto json = relax("in.csv out.obj --talus 89 --sweeps 3");
    EXPECT_EQ(json["corners_added"], 4);
    EXPECT_EQ(json["vertices"], 9);
    EXPECT_EQ(json["triangles"], 8);
    EXPECT_EQ(json["volume_after"], json["volume_before"]);
}

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
    expectRefused("in.asc out.ply --talus 30 --max-error nan", "--max-error must be 0 or more, got nan");
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
