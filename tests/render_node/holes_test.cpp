// SPDX-License-Identifier: Apache-2.0
// Ground without data is not drawn, on a grid and on a TIN.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "render_node/gl/gl_context.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/pictures/sample_scene.hpp"
#include "walls/projection.hpp"

namespace {

using render_node::EyeTarget;
using render_node::ScenePainter;
using sample::Pixels;

using CellMask = std::vector<std::vector<bool>>;  // whether a cell has no data, row by row from the south

/// Returns holes of several forms: a slit one cell wide, a bay at the edge, a single cell, two that touch at a corner,
/// and a round one. The outermost rows and columns have data.
CellMask sampleHoles(int columns, int rows) {
    CellMask holes(static_cast<std::size_t>(rows), std::vector<bool>(static_cast<std::size_t>(columns)));
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const int east = column - 3 * columns / 4, north = row - rows / 2;
            holes[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] =
                (column == 6 && row > 2 && row < 11) || ((column == 9 || column == 10) && row < 4) ||
                (column == 12 && row == 12) || (column == 13 && row == 13) || east * east + north * north < 14;
        }
    }
    return holes;
}

class Holes : public test::FolderTest {
protected:
    /// Returns nearly level ground with these holes, in cells of side 1. The sand is green, the wood brown.
    scene::Scene sceneOf(const CellMask& holes, const std::string& more) {
        std::ofstream raster(folder_ / "t.asc");
        raster << fmt::format("ncols {}\nnrows {}\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n",
                              holes.front().size(), holes.size());
        for (auto row = holes.rbegin(); row != holes.rend(); ++row) {
            for (std::size_t column = 0; column < row->size(); ++column) {
                raster << ((*row)[column] ? -9999 : 3 + 0.02 * std::sin(0.9 * static_cast<double>(column))) << " ";
            }
            raster << "\n";
        }
        raster.close();
        std::ofstream(folder_ / "s.toml") << "[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\"\nlengths = true\n"
                                          << "[material]\n[tool]\nradius = 1.5\n"
                                          << more;
        scene::Scene scene = scene::loadScene(folder_ / "s.toml");
        scene.look.sandColour = {0.1, 0.8, 0.1};
        return scene;
    }

    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
};

// From 400 cells above, sand at a height of 3 is seen less than a tenth of a cell beside its place. The picture has 10
// pixels per cell.
TEST_F(Holes, ShowTheBoxBelowAndNoGround) {
    constexpr int kColumns = 24, kRows = 16, kPerCell = 10;
    const CellMask holes = sampleHoles(kColumns, kRows);
    for (const std::string more : {"", "[tin]\nmax_error = 0\n"}) {
        const scene::Scene scene = sceneOf(holes, more);
        const sand::Replica replica(scene);
        ScenePainter view(scene, replica.surface().data(), glm::dmat4(1));
        const walls::Screen ground{{0, 0, 3}, {kColumns, 0, 3}, {0, kRows, 3}};
        const glm::dvec3 eye(kColumns / 2.0, kRows / 2.0, 400);
        const EyeTarget target(kColumns * kPerCell, kRows * kPerCell);
        const Pixels pixels = sample::draw(view, {walls::viewOf(ground, eye, 100, 500).viewProjection, eye}, target);
        int wrong = 0, open = 0;
        for (int y = 0; y < kRows * kPerCell; ++y) {
            for (int x = 0; x < kColumns * kPerCell; ++x) {
                const int toEdge =
                    std::min({x % kPerCell, kPerCell - 1 - x % kPerCell, y % kPerCell, kPerCell - 1 - y % kPerCell});
                if (toEdge < 2) {
                    continue;  // nearer than a fifth of a cell to another cell
                }
                const auto row = static_cast<std::size_t>(kRows - 1 - y / kPerCell);
                const glm::ivec3 colour = sample::pixel(pixels, target.width(), x, y);
                const bool hole = holes[row][static_cast<std::size_t>(x / kPerCell)];
                wrong += hole == (colour.g > colour.r) ? 1 : 0;
                open += hole ? 1 : 0;
            }
        }
        EXPECT_EQ(wrong, 0) << more;
        EXPECT_GT(open, 1000);
    }
}

// A tool digs along holes and across them, so that their cut edges move. The field is large enough for coarse levels.
TEST_F(Holes, OfDugSandInPartsAreEqualToTheWholeAndToAFreshDrawing) {
    const CellMask holes = sampleHoles(280, 40);
    for (const std::string more : {"", "[tin]\n"}) {
        const scene::Scene scene = sceneOf(holes, more);
        sand::Replica replica(scene);
        const render_node::Camera camera = sample::camera({20, -12, 22}, {14, 12, 3});
        const EyeTarget inParts(240, 160), whole(240, 160);
        render_node::EyeMemory memory;
        ScenePainter view(scene, replica.surface().data(), glm::dmat4(1));
        int parts = 0;
        for (int i = 0; i < 60; ++i) {
            sand::Step step;
            step.number = replica.stepNumber() + 1;
            step.engaged = i < 40;
            step.path = {sample::probeAt(scene, {2 + 0.3 * i, 4 + 0.25 * i, i < 40 ? 4.0 : 7.0})};
            replica.apply(step);
            view.update(replica.surface().data(), replica.takeChange());
            view.setTool(replica.probe(), replica.engaged());
            const render_node::PixelRect drawn = view.drawIfChanged(camera, inParts, memory);
            parts += !drawn.empty() && drawn.area() < 240 * 160 ? 1 : 0;
            ASSERT_TRUE(inParts.read() == sample::draw(view, camera, whole)) << more << ", step " << i;
            if (i % 20 == 19) {
                ScenePainter fresh(scene, sand::Replica(scene).surface().data(), glm::dmat4(1));
                fresh.update(replica.surface().data(), {});
                fresh.setTool(replica.probe(), replica.engaged());
                ASSERT_TRUE(inParts.read() == sample::draw(fresh, camera, whole)) << more << ", step " << i;
            }
        }
        EXPECT_GT(parts, 20) << more;
    }
}

}  // namespace
