// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "tests/scene/relax/relax_tin_fixture.hpp"

namespace {

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
    EXPECT_GT(moved, 0) << "all points stayed in place, but this test needs some that move";
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

}  // namespace
