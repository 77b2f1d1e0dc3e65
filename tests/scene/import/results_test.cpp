// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <sstream>

#include "master/journal/journal.hpp"
#include "sand/replica.hpp"
#include "scene/export/raster.hpp"
#include "scene/import/esri_file.hpp"
#include "scene/import/importer.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/scene/import/import_fixture.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

constexpr int kColumns = 24;
constexpr int kRows = 16;

/// A session on a DEM of hills with a hole, and the output of sandwall-replay for its journal.
class Results : public Import {
protected:
    Results() : replica_(samples::flatScene(1, 1)) {}

    void SetUp() override {
        Import::SetUp();
        Raster raster{.columns = kColumns, .rows = kRows, .type = GDT_Float64, .noData = -1};
        raster.place = {{500000, 2, 0, 4100000, 0, -2}};
        for (int i = 0; i < kColumns * kRows; ++i) {
            raster.heights.push_back(i == 5 * kColumns + 7 ? -1 : 100 + i % 5 * 0.25);
        }
        writeRaster("t.tif", raster);
        scene_ = scene::loadScene(write(
            "s.toml", "[terrain]\nkind = \"dem\"\nfile = \"t.tif\"\ndatum = 100\n[material]\n[tool]\nradius = 5\n"));
        replica_ = sand::Replica(scene_);
        std::mt19937 random(71);
        master::JournalWriter writer(path("s.journal"), scene_, "test");
        for (std::uint64_t number = 1; number <= 8; ++number) {
            const sand::Step step = samples::randomStep(number, scene_.rules, random);
            writer.append({number, replica_.stateHash(), {step}});
            replica_.apply(step);
        }
        writer.finish(replica_.stepNumber(), replica_.stateHash());
    }
    [[nodiscard]] support::Ran replay(const std::string& options) const {
        return support::runProgram("sandwall-replay", path("s.journal") + " " + options);
    }
    [[nodiscard]] std::string bytes(const std::string& name) const {
        std::ifstream stream(path(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    /// Returns how much the sand of a cell has risen [scene unit].
    [[nodiscard]] double risen(int column, int row) const {
        return (samples::fieldOf(replica_).height(column, row) - scene_.terrain.height(column, row)) *
               scene_.terrain.unit();
    }

    scene::Scene scene_;
    sand::Replica replica_;
};

TEST_F(Results, HeightsGoBackWhereTheTerrainCameFrom) {
    ASSERT_EQ(replay("--heights " + path("h.tif")).status, 0);
    const scene::EsriGrid grid = scene::loadImporter("test").readDem(path("h.tif"), {});
    EXPECT_EQ(grid.westEdge, 500000);
    EXPECT_EQ(grid.southEdge, 4100000 - 2 * kRows);
    EXPECT_EQ(grid.cellSize, 2);
    EXPECT_EQ(grid.units.crs, scene_.georeference.units.crs);
    ASSERT_EQ(grid.columns, kColumns);
    for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
            if (column == 7 && row == kRows - 6) {
                EXPECT_TRUE(grid.isNoData(column, row));
                continue;
            }
            ASSERT_NEAR(grid.at(column, row),
                        100 + samples::fieldOf(replica_).height(column, row) * samples::fieldOf(replica_).unit(), 1e-6);
        }
    }
}

TEST_F(Results, TextHasItsSystemBesideIt) {
    ASSERT_EQ(replay("--difference " + path("d.asc")).status, 0);
    const scene::EsriGrid grid = scene::readEsriGrid(path("d.asc"));
    EXPECT_EQ(grid.westEdge, 500000);
    EXPECT_TRUE(grid.isNoData(7, kRows - 6));
    double most = 0;
    for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
            if (!grid.isNoData(column, row)) {
                ASSERT_NEAR(grid.at(column, row), risen(column, row), 1e-6);
                most = std::max(most, std::abs(risen(column, row)));
            }
        }
    }
    EXPECT_GT(most, 0) << "the session dug";
    EXPECT_NE(bytes("d.prj").find("UTM"), std::string::npos);
    EXPECT_NE(scene::loadImporter("test").readDem(path("d.asc"), {}).units.crs.find("UTM"), std::string::npos);
}

TEST_F(Results, CutAndFillAreExact) {
    const support::Ran ran = replay("--volumes");
    ASSERT_EQ(ran.status, 0) << ran.output;
    const auto json = nlohmann::json::parse(ran.output);
    std::int64_t cut = 0;
    std::int64_t fill = 0;
    for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
            const auto change = samples::fieldOf(replica_).height(column, row) - scene_.terrain.height(column, row);
            cut += std::max(-change, 0);
            fill += std::max(change, 0);
        }
    }
    EXPECT_GT(cut, 0);
    EXPECT_EQ(json["units"]["cut"], cut);
    EXPECT_EQ(json["units"]["fill"], fill);
    EXPECT_EQ(cut, fill) << "a closed rim keeps all sand";
    EXPECT_EQ(json["cubic_scene_units"]["cut"], static_cast<double>(cut) * (2.0 / 65536) * 4);
    EXPECT_EQ(json["cubic_metres"]["cut"], json["cubic_scene_units"]["cut"]);
}

TEST_F(Results, AMeshHasTheSurfaceOfTheCellsWithData) {
    ASSERT_EQ(replay("--mesh " + path("m.ply")).status, 0);
    const std::string ply = bytes("m.ply");
    const std::size_t vertices = kColumns * kRows - 1;
    const std::size_t triangles = 2 * (kColumns - 1) * (kRows - 1) - 6;
    const std::string header = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty "
        "double "
        "z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        vertices, triangles);
    ASSERT_EQ(ply.substr(0, header.size()), header);
    ASSERT_EQ(ply.size(), header.size() + vertices * 24 + triangles * 13);
    const scene::Mesh mesh = scene::meshOf(samples::fieldOf(replica_), scene_);
    std::vector<std::array<double, 3>> written(vertices);
    std::memcpy(written.data(), ply.data() + header.size(), vertices * 24);
    EXPECT_EQ(written, mesh.vertices);
    EXPECT_EQ(mesh.vertices[0][0], 500001);
    double area = 0;
    for (std::size_t i = 0; i < triangles; ++i) {
        const char* face = ply.data() + header.size() + vertices * 24 + i * 13;
        ASSERT_EQ(face[0], 3);
        EXPECT_EQ(std::memcmp(face + 1, mesh.triangles[i].data(), 12), 0);
        const auto& [a, b, c] = mesh.triangles[i];
        const auto& va = mesh.vertices[a];
        const auto& vb = mesh.vertices[b];
        const auto& vc = mesh.vertices[c];
        const double doubled = (vb[0] - va[0]) * (vc[1] - va[1]) - (vb[1] - va[1]) * (vc[0] - va[0]);
        EXPECT_EQ(doubled, 4) << "counter-clockwise from above";
        area += doubled / 2;
    }
    EXPECT_EQ(area, 4.0 * (kColumns - 1) * (kRows - 1) - 12);
}

TEST_F(Results, AMeshAsTextIsTheSameMesh) {
    ASSERT_EQ(replay("--mesh " + path("m.obj")).status, 0);
    const scene::Mesh mesh = scene::meshOf(samples::fieldOf(replica_), scene_);
    std::istringstream stream(bytes("m.obj"));
    for (const auto& vertex : mesh.vertices) {
        std::string letter;
        std::array<double, 3> read{};
        stream >> letter >> read[0] >> read[1] >> read[2];
        ASSERT_EQ(letter, "v");
        ASSERT_EQ(read, vertex);
    }
    for (const auto& triangle : mesh.triangles) {
        std::string letter;
        std::array<std::uint32_t, 3> read{};
        stream >> letter >> read[0] >> read[1] >> read[2];
        ASSERT_EQ(letter, "f");
        ASSERT_EQ(read, (std::array<std::uint32_t, 3>{triangle[0] + 1, triangle[1] + 1, triangle[2] + 1}));
    }
}

TEST_F(Results, OutputsThatCannotBeAreRefusedFirst) {
    const support::Ran mesh = replay("--mesh " + path("m.stl"));
    EXPECT_EQ(mesh.status, 2);
    EXPECT_EQ(mesh.output, "sandwall-replay: " + path("m.stl") + ": a mesh is written as .ply or .obj\n");
    EXPECT_EQ(replay("--heights " + path("none/h.tif")).status, 2);
}

TEST_F(Import, PointsGoBackWhereTheyWereSurveyed) {
    write("p.csv",
          "500000,5200000,1200.5\n500040,5200000,1201\n500000,5200030,1202\n500040,5200030,1203\n"
          "500021.25,5200011.5,1199\n");
    const scene::Scene scene = load("[terrain]\nkind = \"points\"\nfile = \"p.csv\"\ndatum = 1200\n[tin]\ncell = 1\n");
    sand::Replica replica(scene);
    master::JournalWriter writer(path("s.journal"), scene, "test");
    writer.finish(replica.stepNumber(), replica.stateHash());
    const support::Ran ran = support::runProgram(
        "sandwall-replay", path("s.journal") + " --volumes --heights " + path("h.asc") + " --mesh " + path("m.obj"));
    ASSERT_EQ(ran.status, 0) << ran.output;
    EXPECT_EQ(
        ran.output,
        "{\"units\":{\"cut\":0,\"fill\":0},\"cubic_scene_units\":{\"cut\":0.0,\"fill\":0.0},\"cubic_metres\":null}"
        "\n");
    const scene::EsriGrid grid = scene::readEsriGrid(path("h.asc"));
    EXPECT_EQ(grid.westEdge, 500000);
    EXPECT_EQ(grid.southEdge, 5200000);
    EXPECT_EQ(grid.columns, 40);
    EXPECT_NEAR(grid.at(21, 11), 1199, 0.1) << "the middle of the cell of the fifth point";
    std::ifstream stream(path("m.obj"));
    std::set<std::array<double, 3>> vertices;
    std::string letter;
    for (std::array<double, 3> vertex{}; stream >> letter >> vertex[0] >> vertex[1] >> vertex[2] && letter == "v";) {
        vertices.insert(vertex);
    }
    const std::set<std::array<double, 3>> points{{500000, 5200000, 1200.5},
                                                 {500040, 5200000, 1201},
                                                 {500000, 5200030, 1202},
                                                 {500040, 5200030, 1203},
                                                 {500021.25, 5200011.5, 1199}};
    EXPECT_TRUE(std::includes(vertices.begin(), vertices.end(), points.begin(), points.end()));
    for (const auto& vertex : vertices) {  // a closed rim has further vertices
        EXPECT_TRUE(points.count(vertex) == 1 || vertex[0] == 500000 || vertex[0] == 500040 || vertex[1] == 5200000 ||
                    vertex[1] == 5200030)
            << vertex[0] << ' ' << vertex[1];
    }
}

}  // namespace
