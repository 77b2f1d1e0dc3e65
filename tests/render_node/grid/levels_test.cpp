// SPDX-License-Identifier: Apache-2.0
#include "render_node/grid/levels.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <map>
#include <numeric>
#include <random>

#include "pictures/compare.hpp"
#include "render_node/gl/gl_context.hpp"
#include "render_node/gl/gl_program.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/pictures/wall_painter.hpp"

namespace {

using render_node::ChunkLevels;
using render_node::EyeTarget;
using render_node::ScenePainter;
using shapes::GridVertex;
using shapes::GridVertices;
using VertexBits = std::array<std::uint32_t, 4>;

constexpr int kSide = 32;   // [quad], side of a chunk
constexpr int kChunks = 4;  // number of chunks along a side of the field

double random(std::mt19937& source, double most) { return static_cast<double>(source() % 1000U) / 1000 * most; }

/// Hills of many sizes.
sand::HeightField hills(int columns, int rows, std::uint32_t seed) {
    sand::HeightField field(columns, rows, 1);
    std::mt19937 source(seed);
    for (int i = 0; i < 60; ++i) {
        const double x = random(source, columns), y = random(source, rows);
        const double wide = 2 + random(source, 20), high = (random(source, 2) - 1) * wide / 3;
        for (int row = 0; row < rows; ++row) {
            for (int column = 0; column < columns; ++column) {
                const double square = ((column - x) * (column - x) + (row - y) * (row - y)) / (wide * wide);
                field.setHeight(
                    column, row,
                    field.height(column, row) + static_cast<int>(high * sand::kUnitsPerCell / (1 + square)));
            }
        }
    }
    return field;
}

sand::CellRect chunkAt(int x, int y) { return {x * kSide, y * kSide, (x + 1) * kSide + 1, (y + 1) * kSide + 1}; }

using GridPoint = std::pair<int, int>;  // column and row of the vertex grid

/// Field whose chunks have random levels.
class Patchwork {
public:
    explicit Patchwork(std::uint32_t seed) : random_(seed) {
        for (int& level : levels_) {
            level = static_cast<int>(random_() % shapes::kLevels);
        }
    }
    [[nodiscard]] ChunkLevels at(int x, int y) const {
        const int own = level(x, y);
        const auto edge = [&](int u, int v) {
            const bool rim = u < 0 || v < 0 || u == kChunks || v == kChunks;
            return rim ? 0 : std::min(own, level(u, v));
        };
        return {own, {edge(x, y - 1), edge(x + 1, y), edge(x, y + 1), edge(x - 1, y)}};
    }

private:
    [[nodiscard]] int level(int x, int y) const { return levels_.at(static_cast<std::size_t>(y * kChunks + x)); }
    std::mt19937 random_;
    std::array<int, kChunks * kChunks> levels_{};
};

// For every edge of a triangle there must be an edge in the opposite direction between the same two vertices.
TEST(Levels, OfAnyPatchworkMeetWithoutCracks) {
    const GridVertices surface(hills(kChunks * kSide - 1, kChunks * kSide - 1, 1));
    for (std::uint32_t seed = 1; seed <= 8; ++seed) {
        const Patchwork patchwork(seed);
        std::map<GridPoint, GridVertex> vertices;
        std::map<std::pair<GridPoint, GridPoint>, int> edges;
        for (int chunk = 0; chunk < kChunks * kChunks; ++chunk) {
            const int x = chunk % kChunks, y = chunk / kChunks;
            const ChunkLevels levels = patchwork.at(x, y);
            const std::vector<GridVertex> own = render_node::verticesOf(surface, chunkAt(x, y), levels);
            const std::vector<std::uint16_t> triangles = render_node::trianglesOf(kSide, kSide, levels);
            for (std::size_t i = 0; i < triangles.size(); ++i) {
                const GridVertex& from = own.at(triangles[i]);
                const GridVertex& to = own.at(triangles[i % 3 == 2 ? i - 2 : i + 1]);
                ++edges[{{from.column, from.row}, {to.column, to.row}}];
                const GridVertex& known = vertices.try_emplace({from.column, from.row}, from).first->second;
                ASSERT_EQ(std::bit_cast<VertexBits>(known), std::bit_cast<VertexBits>(from));
            }
        }
        constexpr int kLast = kChunks * kSide;
        int open = 0;
        for (const auto& [edge, times] : edges) {
            ASSERT_EQ(times, 1) << "seed " << seed;
            open += edges.contains({edge.second, edge.first}) ? 0 : 1;
        }
        EXPECT_EQ(open, 4 * kLast) << "seed " << seed << ": only the rim is open, at all of its vertices";
    }
}

/// Returns the largest distance of a chunk's triangles from the vertices below or above them [cell].
double distanceOf(const GridVertices& surface, const sand::CellRect& chunk, const ChunkLevels& levels) {
    const std::vector<GridVertex> own = render_node::verticesOf(surface, chunk, levels);
    const std::vector<std::uint16_t> triangles = render_node::trianglesOf(kSide, kSide, levels);
    double most = 0;
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        std::array<glm::dvec3, 3> corner{};
        for (std::size_t j = 0; j < 3; ++j) {
            const GridVertex& vertex = own.at(triangles[i + j]);
            corner[j] = {surface.east(vertex.column / 2), surface.north(vertex.row / 2), vertex.height};
        }
        const glm::dvec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
        for (int row = chunk.y0; row < chunk.y1; ++row) {
            for (int column = chunk.x0; column < chunk.x1; ++column) {
                const glm::dvec2 at(surface.east(column), surface.north(row));
                bool inside = true;
                for (std::size_t j = 0; j < 3; ++j) {
                    const glm::dvec2 along = glm::dvec2(corner[(j + 1) % 3]) - glm::dvec2(corner[j]);
                    const glm::dvec2 away = at - glm::dvec2(corner[j]);
                    inside = inside && along.x * away.y - along.y * away.x >= -1e-9;
                }
                if (inside) {
                    const glm::dvec2 away = at - glm::dvec2(corner[0]);
                    const double height = corner[0].z - (normal.x * away.x + normal.y * away.y) / normal.z;
                    most = std::max(most, std::abs(height - double{surface.height(column - 1, row - 1)}));
                }
            }
        }
    }
    return most;
}

TEST(Levels, AreAsFarFromTheSandAsTheySay) {
    const GridVertices surface(hills(kChunks * kSide - 1, kChunks * kSide - 1, 2));
    const glm::vec3 sun = glm::normalize(glm::vec3(-0.55, 0.35, 0.6));
    for (int chunk = 0; chunk < kChunks * kChunks; chunk += 3) {
        const sand::CellRect vertices = chunkAt(chunk % kChunks, chunk / kChunks);
        const auto errors = render_node::errorsOf(surface, vertices, sun, 0, shapes::kLevels - 1);
        for (int level = 1; level < shapes::kLevels; ++level) {
            const double said = errors.height[static_cast<std::size_t>(level)];
            // The north and east edges belong to the chunks beyond them.
            const double whole = distanceOf(surface, vertices, {level, {level, level, level, level}});
            EXPECT_GE(whole, 0.999 * said) << "chunk " << chunk << ", level " << level;
            const double inner = distanceOf(surface, vertices, {level, {0, 0, 0, 0}});
            EXPECT_LE(inner, 1.5 * said) << "chunk " << chunk << ", level " << level << ": between finer neighbours";
        }
    }
}

TEST(Levels, AreMeasuredFromTheFinestThatAPictureShows) {
    constexpr int kFinest = 2, kStep = 1 << kFinest, kCells = 128;
    const sand::HeightField all = hills(kCells, kCells, 2);
    // The cell under vertex v of the large field is v - 1. The small field has the heights under every fourth vertex.
    sand::HeightField few(kCells / kStep, kCells / kStep,
                          1);  // the errors of heights do not depend on the size of cells
    for (int row = 0; row < few.rows(); ++row) {
        for (int column = 0; column < few.columns(); ++column) {
            few.setHeight(column, row, all.height((column + 1) * kStep - 1, (row + 1) * kStep - 1));
        }
    }
    const glm::vec3 sun = glm::normalize(glm::vec3(-0.55, 0.35, 0.6));
    const GridVertices fine(all), coarse(few);
    const auto said = render_node::errorsOf(fine, {32, 32, 65, 65}, sun, kFinest, shapes::kLevels - 1);
    const auto right = render_node::errorsOf(coarse, {8, 8, 17, 17}, sun, 0, shapes::kLevels - 1 - kFinest);
    for (int level = 0; level < shapes::kLevels; ++level) {
        const float height = level <= kFinest ? 0.0F : right.height.at(static_cast<std::size_t>(level - kFinest));
        EXPECT_FLOAT_EQ(said.height.at(static_cast<std::size_t>(level)), height) << "level " << level;
        EXPECT_EQ(said.light.at(static_cast<std::size_t>(level)) > 0, level > kFinest) << "level " << level;
    }
}

// grid/levels.cpp weighs mottling as the shader does. The test compares the two, because neither can read the other.
TEST(Levels, CountMottlingAsTheShaderShadesIt) {
    const std::string& shader = render_node::shaderSource("sunlit.glsl").text;
    EXPECT_NE(shader.find("* (0.86 + 0.28 * mottling)"), std::string::npos) << shader;
}

// Tiles of one plane, seen by one eye, must draw each chunk alike.
TEST(Levels, AreThoseOfEveryTileOfAPlane) {
    const walls::Wall wall = walls::loadWall(sample::wallFolder() / "tiled_3x4.toml");
    const glm::dmat4 sceneToRoom = walls::stageToRoom(wall.stage, 2, 2, 0);
    std::mt19937 source(3);
    int coarse = 0;
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 low(random(source, 2), random(source, 2), 0);
        const double cell = 0.002 + random(source, 0.01);
        render_node::LevelErrors errors;
        for (std::size_t level = 1; level < shapes::kLevels; ++level) {
            errors.height[level] = static_cast<float>(random(source, 1e-3)) + errors.height[level - 1];
        }
        std::array<int, shapes::kLevels> asked{}, moving{}, shown{};
        for (const walls::Tile& tile : wall.tiles) {
            const auto seen = walls::viewOf(tile.screen, wall.viewer.eye, wall.clip.near, wall.clip.far);
            const render_node::LevelRule rule(seen.viewProjection * sceneToRoom, tile.pixels, 0.5);
            const int finest = rule.finest({low, low + 0.03}, cell / 8, shapes::kLevels - 1);
            ++shown.at(static_cast<std::size_t>(finest));
            ++asked.at(static_cast<std::size_t>(rule.level({low, low + 0.03}, errors, finest, shapes::kLevels - 1)));
            ++moving.at(static_cast<std::size_t>(
                rule.levelWhileMoving({low, low + glm::dvec3(0.03, 0.03, 0.02)}, cell, shapes::kLevels - 1).value()));
        }
        EXPECT_EQ(*std::ranges::max_element(asked), static_cast<int>(wall.tiles.size())) << "box " << i;
        EXPECT_EQ(*std::ranges::max_element(shown), static_cast<int>(wall.tiles.size())) << "box " << i;
        EXPECT_EQ(*std::ranges::max_element(moving), static_cast<int>(wall.tiles.size())) << "box " << i;
        coarse += asked[0] == 0 ? 1 : 0;
    }
    EXPECT_GT(coarse, 200);
    EXPECT_LT(coarse, 1800);
}

/// Returns a strip of dunes with a furrow, large enough for three levels.
class LargeField : public testing::Test {
protected:
    static scene::Scene strip() {
        scene::Scene scene = sample::flatScene(2048, 256, 0.012);
        sand::grid::makeDunes({.height = 0.008, .length = 0.1}, scene.terrain);  // the dunes are at rest
        return scene;
    }
    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
    scene::Scene scene_ = strip();
    sand::Replica replica_{scene_};
};

// The floor of the box is below the sand. Through a crack the floor would be visible, deeper than any sand.
TEST_F(LargeField, ShowsNoHoleAtAnyBound) {
    sample::drag(replica_, scene_, {0.6, 0.1, 0.005}, {0.9, 0.16, 0.0});
    ScenePainter view(scene_, glm::dmat4(1));
    view.update(replica_.surface().data(), {});
    const EyeTarget target(320, 240);
    for (const glm::dvec3& eye :
         {glm::dvec3(0.75, 0.12, 0.2), glm::dvec3(0.75, 0.03, 0.09), glm::dvec3(0.9, 0.2, 0.15)}) {
        const render_node::Camera camera = sample::camera(eye, {0.76, 0.13, 0}, {0.25, 0.25, 0.75, 0.75});
        const glm::dmat4 back = glm::inverse(camera.roomToClip);
        sample::Pixels exact;
        int coarse = 0;
        for (const double bound : {0.0, 0.5, 4.0, 64.0}) {
            view.setDetail(bound);
            const sample::Pixels picture = sample::draw(view, camera, target);
            exact = bound == 0 ? picture : exact;
            coarse = view.counts().coarseChunks;
            EXPECT_EQ(coarse > 0, bound > 0);
            std::vector<float> depth(320UL * 240);
            glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer());
            glReadPixels(0, 0, 320, 240, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
            int holes = 0;
            for (std::size_t i = 0; i < depth.size(); ++i) {
                const std::size_t column = i % 320, row = i / 320;
                const double x = (double(column) + 0.5) / 160 - 1, y = (double(row) + 0.5) / 120 - 1;
                const glm::dvec4 at = back * glm::dvec4(x, y, 2 * double{depth[i]} - 1, 1);
                holes += at.z / at.w < -0.05 ? 1 : 0;
            }
            EXPECT_EQ(holes, 0) << "bound " << bound;
            int bad = 0;
            for (std::size_t i = 0; i < picture.size(); ++i) {
                bad += std::abs(picture[i] - exact[i]) > 8 ? 1 : 0;
            }
            if (bound == 0.5) {
                EXPECT_LE(bad, static_cast<int>(picture.size()) / 100);
            }
        }
        EXPECT_GT(coarse, 0);
    }
}

// While a hand digs, chunks and their neighbours' edges change their levels. Sometimes the head moves.
TEST_F(LargeField, DrawnInPartsIsEqualToTheWhole) {
    ScenePainter view(scene_, glm::dmat4(1));
    constexpr int kEyes = 2;
    std::vector<EyeTarget> targets;
    targets.reserve(kEyes);
    std::array<render_node::EyeMemory, kEyes> memories;
    const EyeTarget whole(160, 60);
    for (int eye = 0; eye < kEyes; ++eye) {
        targets.emplace_back(160, 60);
    }
    glm::dvec3 head(0.8, -0.1, 0.35);
    int inPart = 0, fewest = 1 << 30, most = 0;
    for (int i = 0; i < 30; ++i) {
        const glm::dvec3 hand(0.5 + 0.012 * i, 0.06 + 0.004 * i, i < 22 ? 0.004 : 0.03);
        replica_.apply({0, replica_.stepNumber() + 1, i < 22, {sample::probeAt(scene_, hand)}});
        view.update(replica_.surface().data(), replica_.takeChange());
        view.setTool(replica_.probe(), replica_.engaged());
        head += i % 9 == 8 ? glm::dvec3(0.02, -0.01, 0.01) : glm::dvec3(0);
        for (std::size_t eye = 0; eye < kEyes; ++eye) {
            const glm::dvec3 place = head + glm::dvec3(0.06 * double(eye), 0, 0);
            const auto camera = sample::camera(place, place + glm::dvec3(0, 0.25, -0.35));
            const auto drawn = view.drawIfChanged(camera, targets[eye], memories[eye]);
            inPart += drawn.area() > 0 && drawn.area() < 160 * 60 ? 1 : 0;
            const sample::Pixels expected = sample::draw(view, camera, whole);
            fewest = std::min(fewest, view.counts().coarseChunks);
            most = std::max(most, view.counts().coarseChunks);
            ASSERT_TRUE(targets[eye].read() == expected) << "step " << i << ", eye " << eye;
        }
    }
    EXPECT_GT(inPart, 30);
    EXPECT_GT(fewest, 0);
    EXPECT_LT(fewest + 4, most) << "no chunk has become finer";
    ScenePainter fresh(scene_, glm::dmat4(1));
    fresh.update(replica_.surface().data(), {});
    fresh.setTool(replica_.probe(), replica_.engaged());
    const auto camera = sample::camera(head, head + glm::dvec3(0, 0.25, -0.35));
    EXPECT_TRUE(sample::draw(fresh, camera, whole) == targets[0].read());
}

/// Returns the mean of the channels in the middle half of a picture's rows [level].
double meanOfMiddle(const sample::Pixels& picture) {
    const auto quarter = static_cast<std::ptrdiff_t>(picture.size() / 4);
    return std::accumulate(picture.begin() + quarter, picture.end() - quarter, 0.0) / static_cast<double>(2 * quarter);
}

// Each cell of rough sand differs from its neighbours, so that errors alone would ask for every cell.
TEST(FineCells, CostByThePixel) {
    const auto context = render_node::makeOffscreenContext(render_node::Backend::automatic);
    scene::Scene scene = sample::flatScene(1024, 512);
    std::mt19937 source(7);
    for (int row = 0; row < 512; ++row) {
        for (int column = 0; column < 1024; ++column) {
            scene.terrain.setHeight(column, row, static_cast<std::int32_t>(source() % 8) * sand::kUnitsPerCell);
        }
    }
    const sand::Replica replica(scene);
    constexpr int kPixelsAcross = 128, kPixelsDown = 96;  // nearly nine cells a pixel along each side
    const EyeTarget target(kPixelsAcross, kPixelsDown);
    const render_node::Camera camera = sample::camera({1, 0.5, 2.2}, {1, 0.5, 0});
    ScenePainter view(scene, glm::dmat4(1));
    view.update(replica.surface().data(), {});
    const sample::Pixels usual = sample::draw(view, camera, target);
    EXPECT_LT(view.counts().triangles, 2 * kPixelsAcross * kPixelsDown) << "a finer level has four times as many";
    view.setDetail(0);
    const sample::Pixels exact = sample::draw(view, camera, target);
    EXPECT_GT(view.counts().triangles, 2 * 1000 * 500);
    EXPECT_NEAR(meanOfMiddle(usual), meanOfMiddle(exact), 1) << "the sand is as bright";
}

}  // namespace
