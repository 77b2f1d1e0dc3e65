// SPDX-License-Identifier: Apache-2.0
// Results are put back where the terrain came from: places and heights, cell by cell and vertex by vertex.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "scene/export/raster.hpp"
#include "scene/export/tin_raster.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/sand/sand_of.hpp"

namespace exported {
namespace {

using sand::kUnitsPerCell;
using Vertex = std::array<double, 3>;
using Triangle = std::array<std::uint32_t, 3>;

constexpr double kCell = 1.5;  // [scene unit]

/// Origin of a terrain whose length unit is a quarter of a scene unit, with heights exaggerated twice.
scene::Georeference origin() {
    scene::Georeference reference;
    reference.west = 1000;
    reference.south = 5000;
    reference.lengthPerUnit = 4;
    reference.heightPerUnit = 2;
    reference.datum = 10;
    return reference;
}

/// Level sand on three by two cells, with a wall in one of them.
class Export : public testing::Test {
protected:
    Export() {
        scene_.terrain = sand::HeightField(kColumns, kRows, kCell);
        scene_.georeference = origin();
        scene_.rules.columns = kColumns;
        scene_.rules.rows = kRows;
        auto ground = std::make_shared<sand::Ground>(kColumns, kRows);
        ground->setWall(2, 1);
        scene_.ground = std::move(ground);
        for (int row = 0; row < kRows; ++row) {
            for (int column = 0; column < kColumns; ++column) {
                field_.setHeight(column, row, (column + 10 * row) * kUnitsPerCell);
            }
        }
    }
    static constexpr int kColumns = 3, kRows = 2;

    scene::Scene scene_;
    sand::HeightField field_{kColumns, kRows, kCell};
};

// A cell is 1.5 scene units wide, which are 6 units of the source. A height unit is 1.5 scene units, above the datum of
// 10, which are 3 units above 20. The vertices lie in the middles of the cells.
TEST_F(Export, AMeshHasItsVerticesInTheMiddlesOfTheCells) {
    const scene::Mesh mesh = scene::meshOf(field_, scene_);
    EXPECT_EQ(mesh.vertices,
              (std::vector<Vertex>{
                  {1003, 5003, 20}, {1009, 5003, 23}, {1015, 5003, 26}, {1003, 5009, 50}, {1009, 5009, 53}}));
    EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 4}, {0, 4, 3}})) << "none has the wall as a corner";
}

// The rows of a raster begin in the north. at() counts them from the south.
TEST_F(Export, ARasterHasItsCellsWhereTheTerrainHasThem) {
    const scene::EsriGrid grid = scene::heightsOf(field_, scene_);
    EXPECT_EQ(grid.westEdge, 1000);
    EXPECT_EQ(grid.southEdge, 5000);
    EXPECT_EQ(grid.cellSize, 6);
    for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
            const bool wall = column == 2 && row == 1;
            EXPECT_EQ(grid.isNoData(column, row), wall);
            EXPECT_TRUE(wall || grid.at(column, row) == 20 + 3 * column + 30 * row) << column << ", " << row;
        }
    }
    EXPECT_EQ(grid.heights[0], 50) << "the north-west";
    const scene::EsriGrid difference = scene::differenceOf(field_, scene_);
    EXPECT_EQ(difference.southEdge, 5000);
    EXPECT_EQ(difference.at(1, 1), 33) << "the datum is in both";
}

/// A plane over 4 by 3 cells that rises by 2 cells per cell to the east and by 1 per cell to the north.
scene::Scene inclinedTin() {
    sand::tin::TinStart start;
    start.width = 4 * sand::kProbePerCell;
    start.depth = 3 * sand::kProbePerCell;
    start.places = {{0, 0}, {start.width, 0}, {start.width, start.depth}, {0, start.depth}, {300, 500}};
    for (const sand::tin::LatticePoint& place : start.places) {
        start.heights.push_back((2 * place.x + place.y) * (kUnitsPerCell / sand::kProbePerCell));
    }
    scene::Scene scene;
    scene.terrain = sand::HeightField(4, 3, kCell);
    scene.georeference = origin();
    scene.rules.columns = 4;
    scene.rules.rows = 3;
    scene.rules.tuning.threshold = scene.rules.tuning.startThreshold = 4 * kUnitsPerCell;
    scene.rules.tuning.tool.radius = sand::kProbePerCell;
    scene.tin = std::make_shared<const sand::tin::TinStart>(std::move(start));
    return scene;
}

// A unit beside its own place: a vertex of the plane may be rounded by one unit of volume.
TEST(ExportOfATin, IsSampledInTheMiddlesOfTheCells) {
    const sand::HeightField field = scene::sampled(sand::Replica(inclinedTin()), nullptr);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            EXPECT_NEAR(field.height(column, row), (2 * (column + 0.5) + row + 0.5) * kUnitsPerCell, 1)
                << column << ", " << row;
        }
    }
}

TEST(ExportOfATin, AMeshHasItsVerticesWhereTheTinHasThem) {
    const scene::Scene scene = inclinedTin();
    const sand::Replica replica(scene);
    const scene::Mesh mesh = scene::meshOf(samples::tinOf(replica), scene);
    const double probe = 6.0 / sand::kProbePerCell;  // [unit of the source]
    ASSERT_EQ(mesh.vertices.size(), scene.tin->places.size());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const sand::tin::LatticePoint& place = scene.tin->places[i];
        EXPECT_DOUBLE_EQ(mesh.vertices[i][0], 1000 + place.x * probe) << i;
        EXPECT_DOUBLE_EQ(mesh.vertices[i][1], 5000 + place.y * probe) << i;
        EXPECT_NEAR(mesh.vertices[i][2], 20 + 3.0 * (2 * place.x + place.y) / sand::kProbePerCell, 1e-4) << i;
    }
    double area = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vertex &va = mesh.vertices[a], &vb = mesh.vertices[b], &vc = mesh.vertices[c];
        const double doubled = (vb[0] - va[0]) * (vc[1] - va[1]) - (vb[1] - va[1]) * (vc[0] - va[0]);
        EXPECT_GT(doubled, 0) << "counter-clockwise from above";
        area += doubled / 2;
    }
    EXPECT_DOUBLE_EQ(area, 24.0 * 18);
}

}  // namespace
}  // namespace exported
