// SPDX-License-Identifier: Apache-2.0
// Sessions that are drawn twice, in parts and whole. Every frame must be equal in every byte.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "render_node/gl/gl_context.hpp"
#include "render_node/tool/force.hpp"
#include "scene/scene.hpp"
#include "tests/render_node/wall_painter.hpp"

namespace {

using lockstep::Overlay;
using render_node::EyeTarget;
using render_node::PixelRect;
using render_node::ScenePainter;
using sample::Pixels;

constexpr int kSteps = 170;

/// Strokes of a hand: it drags through the sand, lifts, rests while sand slides, and digs along the rim and across it.
sand::Step stepOf(const scene::Scene& scene, int i) {
    const auto between = [&](int first, int end, glm::dvec3 from, glm::dvec3 to) {
        return glm::mix(from, to, double(i - first) / (end - first));
    };
    sand::Step step;
    step.number = static_cast<std::uint64_t>(i) + 1;
    step.engaged = i < 50 || (i >= 90 && i < 130);
    if (i < 50) {
        step.path = {sample::probeAt(scene, between(0, 50, {0.3, 0.5, 0.03}, {1.5, 0.9, -0.01}))};
    } else if (i < 70) {
        step.path = {sample::probeAt(scene, between(50, 70, {1.5, 0.9, 0.05}, {1.2, 1.2, 0.5}))};
    } else if (i >= 90 && i < 130) {
        step.path = {sample::probeAt(scene, between(90, 130, {1.8, 0.1, 0.04}, {2.02, 1.2, -0.02}))};
    } else if (i >= 130 && i < 150) {
        step.path = {sample::probeAt(scene, between(130, 150, {2.1, 1.2, 0.1}, {-0.1, -0.05, 0.3}))};
    }
    return step;
}

/// Returns steep heaps, so that sand still slides while the hand rests.
scene::Scene sessionScene(sand::Rim rim) {
    scene::Scene scene = sample::duneScene(128);
    scene.rules.rim = rim;
    scene.rules.toolRadius = static_cast<std::int32_t>(0.05 / scene.terrain.cellSize() * sand::kProbePerCell);
    return scene;
}

/// One eye of one tile, drawn both ways.
struct Twice {
    walls::Screen screen;
    walls::Eye eye;
    EyeTarget inParts, whole;
    render_node::EyeMemory memory{};
    Pixels before{};

    Twice(const walls::Tile& tile, walls::Eye shown)
        : screen(tile.screen), eye(shown), inParts(tile.pixels.x, tile.pixels.y), whole(tile.pixels.x, tile.pixels.y) {}
};

/// Things that a step's frame shows in addition to the sand.
struct Shown {
    lockstep::Overlays layers;
    std::optional<render_node::ForceArrow> force;
};

using LayersAt = lockstep::Overlays (*)(int step);
lockstep::Overlays noLayers(int) { return {}; }
template <Overlay... layers>
lockstep::Overlays always(int) {
    lockstep::Overlays shown;
    (shown.set(layers, true), ...);
    return shown;
}

struct Tally {
    int skipped = 0, inPart = 0, whole = 0;
    double pixels = 0, all = 0;
};

/// Returns the smallest rectangle around all pixels that differ.
PixelRect difference(const Pixels& a, const Pixels& b, int width) {
    PixelRect found{};
    const int height = static_cast<int>(a.size()) / 3 / width;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (sample::pixel(a, width, x, y) != sample::pixel(b, width, x, y)) {
                found = around(found, {x, height - 1 - y, x + 1, height - y});
            }
        }
    }
    return found;
}

class Redraw : public testing::Test {
protected:
    /// Draws one eye both ways and compares the pictures. The first difference fails the test.
    static void drawTwice(ScenePainter& view, const walls::Wall& wall, const walls::Viewer& viewer, Twice& twice,
                          Tally& tally) {
        const glm::dvec3 position = walls::eyePosition(viewer, twice.eye);
        const render_node::Camera camera{
            walls::viewOf(twice.screen, position, wall.clip.near, wall.clip.far).viewProjection, position};
        const PixelRect drawn = view.drawIfChanged(camera, twice.inParts, twice.memory);
        const Pixels whole = sample::draw(view, camera, twice.whole);
        ASSERT_TRUE(twice.inParts.read() == whole)
            << "drawn: columns " << drawn.x0 << " to " << drawn.x1 << ", rows " << drawn.y0 << " to " << drawn.y1;
        const std::int64_t all = std::int64_t{twice.whole.width()} * twice.whole.height();
        tally.all += static_cast<double>(all);
        tally.pixels += static_cast<double>(drawn.area());
        (drawn.empty() ? tally.skipped : drawn.area() < all ? tally.inPart : tally.whole) += 1;
        twice.before = whole;
    }

    /// Checks that another view of the same scene, which takes over the whole sand at once, draws the same picture.
    static void checkAgainstFreshView(const scene::Scene& scene, const sand::Replica& terrain,
                                      const glm::dmat4& sceneToRoom, const Shown& shown,
                                      const render_node::Camera& camera, const Twice& twice) {
        ScenePainter fresh(scene, sceneToRoom);
        fresh.update(terrain.surface().data(), {});
        fresh.setTool(terrain.probe(), terrain.engaged());
        fresh.setLayers(shown.layers);
        fresh.setForce(shown.force);
        ASSERT_TRUE(sample::draw(fresh, camera, twice.whole) == twice.before);
    }

    /// Runs the whole session on these tiles of a wall, counted from 0. With `headMoves` the viewer moves every 23
    /// steps.
    static Tally play(const std::string& name, int smaller, const std::vector<std::size_t>& tiles, sand::Rim rim,
                      bool headMoves, walls::Stereo stereo, LayersAt layersAt = noLayers) {
        walls::Wall wall = sample::reduced(walls::loadWall(sample::wallFolder() / (name + ".toml")), smaller);
        const scene::Scene scene = sessionScene(rim);
        sand::Replica terrain(scene);
        const double width = scene.terrain.columns() * scene.terrain.cellSize();
        const glm::dmat4 sceneToRoom = walls::stageToRoom(
            wall.stage, width, width, static_cast<double>(scene.referenceHeight()) * scene.terrain.unit());
        ScenePainter view(scene, sceneToRoom);
        std::vector<Twice> eyes;
        for (const std::size_t tile : tiles) {
            for (const walls::Eye eye : walls::eyesOf(stereo)) {
                eyes.emplace_back(wall.tiles.at(tile), eye);
            }
        }
        walls::Viewer viewer = wall.viewer;
        Tally tally;
        render_node::ToolForce force(scene.force);
        for (int i = 0; i < kSteps; ++i) {
            terrain.apply(stepOf(scene, i));
            view.update(terrain.surface().data(), terrain.takeChange());
            view.setTool(terrain.probe(), terrain.engaged());
            Shown shown{layersAt(i), force.arrow(terrain)};
            shown.force = shown.layers.shows(Overlay::force) ? shown.force : std::nullopt;
            view.setLayers(shown.layers);
            view.setForce(shown.force);
            if (headMoves && i % 23 == 22) {
                viewer.eye += glm::dvec3(0.03, -0.02, 0.01);
            }
            for (std::size_t at = 0; at < eyes.size(); ++at) {
                SCOPED_TRACE(name + ": step " + std::to_string(i) + ", eye " + std::to_string(at));
                drawTwice(view, wall, viewer, eyes[at], tally);
                if (HasFatalFailure()) {
                    return tally;
                }
            }
            if (i % 40 == 39) {
                const glm::dvec3 position = walls::eyePosition(viewer, eyes[0].eye);
                const auto seen = walls::viewOf(eyes[0].screen, position, wall.clip.near, wall.clip.far);
                checkAgainstFreshView(scene, terrain, sceneToRoom, shown, {seen.viewProjection, position}, eyes[0]);
            }
        }
        std::printf("%s: %d views skipped, %d drawn in part, %d whole; %.1f %% of the pixels\n", name.c_str(),
                    tally.skipped, tally.inPart, tally.whole, 100 * tally.pixels / tally.all);
        return tally;
    }

    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
};

TEST_F(Redraw, OfADesktopInPartsIsEqualToTheWhole) {
    const Tally tally = play("desktop", 8, {0}, sand::Rim::closed, false, walls::Stereo::mono);
    EXPECT_GT(tally.inPart, kSteps / 3);
}

TEST_F(Redraw, OfATiledWallInStereoIsEqualToTheWhole) {
    const Tally tally = play("tiled_3x4", 8, {5, 9, 10}, sand::Rim::open, false, walls::Stereo::passive);
    EXPECT_GT(tally.inPart, kSteps / 2);
    EXPECT_GT(tally.skipped, kSteps / 2);
}

TEST_F(Redraw, UnderAMovingHeadIsEqualToTheWhole) {
    const Tally tally = play("tiled_3x4", 8, {10}, sand::Rim::closed, true, walls::Stereo::passive);
    EXPECT_GE(tally.whole, 2 * (1 + kSteps / 23));
    EXPECT_GT(tally.inPart, kSteps / 3);
}

TEST_F(Redraw, OfACaveAroundTheViewerIsEqualToTheWhole) {
    const Tally tally = play("flex_cave", 8, {1, 3}, sand::Rim::open, true, walls::Stereo::active);
    EXPECT_GT(tally.inPart, kSteps);
}

TEST_F(Redraw, WithAWireframeIsEqualToTheWhole) {
    const Tally tally =
        play("tiled_3x4", 8, {10}, sand::Rim::open, false, walls::Stereo::passive, always<Overlay::wireframe>);
    EXPECT_GE(tally.whole, 2);
    EXPECT_GT(tally.inPart, kSteps / 3);
}

TEST_F(Redraw, WithHillShadeIsEqualToTheWhole) {
    const Tally tally =
        play("tiled_3x4", 8, {10}, sand::Rim::closed, false, walls::Stereo::passive, always<Overlay::hillShade>);
    EXPECT_GE(tally.whole, 2);
    EXPECT_GT(tally.inPart, kSteps / 3);
}

TEST_F(Redraw, WithTheForcesArrowIsEqualToTheWhole) {
    const Tally tally = play("desktop", 8, {0}, sand::Rim::closed, false, walls::Stereo::mono, always<Overlay::force>);
    EXPECT_GE(tally.whole, 1);
    EXPECT_GT(tally.inPart, kSteps / 3);
}

// Each layer is shown and hidden while the tool drags, rests and digs along the rim. Two layers change in one frame.
TEST_F(Redraw, WhileLayersAreSwitchedIsEqualToTheWhole) {
    const LayersAt switched = [](int step) {
        lockstep::Overlays layers;
        layers.set(Overlay::wireframe, (step >= 10 && step < 20) || step >= 110);
        layers.set(Overlay::hillShade, (step >= 15 && step < 30) || (step >= 75 && step < 80));
        layers.set(Overlay::force, (step >= 5 && step < 40) || (step >= 95 && step < 125));
        layers.set(Overlay::statistics, step % 7 == 0);  // does not change the sand's picture
        return layers;
    };
    const Tally tally = play("desktop", 8, {0}, sand::Rim::closed, false, walls::Stereo::mono, switched);
    EXPECT_GE(tally.whole, 1 + 7);
    EXPECT_GT(tally.inPart, kSteps / 3);
    EXPECT_GT(tally.skipped, 0);
}

/// Returns the distance of a change from the nearest edge of the rectangle that is inside the picture [pixel].
int slack(const PixelRect& drawn, const PixelRect& changed, const EyeTarget& target) {
    int least = 1000;
    const auto edge = [&](bool within, int gap) { least = within ? std::min(least, gap) : least; };
    edge(drawn.x0 > 0, changed.x0 - drawn.x0);
    edge(drawn.y0 > 0, changed.y0 - drawn.y0);
    edge(drawn.x1 < target.width(), drawn.x1 - changed.x1);
    edge(drawn.y1 < target.height(), drawn.y1 - changed.y1);
    return least;
}

// Both corners of the field change. A rectangle around them would be the whole field.
TEST_F(Redraw, ReadsOnlyWhatIsListedAndWhatLiesAroundIt) {
    scene::Scene scene = sample::flatScene(512, 512);
    ScenePainter view(scene, glm::dmat4(1));
    for (const int corner : {100, 400}) {
        scene.terrain.setHeight(corner, corner, sand::kUnitsPerCell);
    }
    const std::int64_t before = view.placesRead();
    view.update(sand::GridData{scene.terrain},
                {.whole = false, .parts = sand::CellChange{{{96, 96, 104, 104}, {400, 400, 408, 408}}}});
    // For each of two blocks of 64 cells, reads the cells around it within reach of light (10 cells) and of a triangle
    // of level 2 (4 cells): 29 × 29 cells. Also reads the heights of at most nine chunks of 17 × 17 cells.
    EXPECT_LT(view.placesRead() - before, 2 * (64 + 29 * 29 + 9 * 17 * 17));
    EXPECT_GE(view.placesRead() - before, 2 * 64);
}

// Seen from the side, a post of 30 cells hides sand far behind it.
TEST_F(Redraw, ErasesAPostThatIsGone) {
    scene::Scene scene = sample::flatScene(128, 128);
    scene.terrain.setHeight(64, 30, 30 * sand::kUnitsPerCell);
    ScenePainter view(scene, glm::dmat4(1));
    const render_node::Camera beside = sample::camera({1, -1.2, 0.7}, {1, 1, 0});
    const EyeTarget inParts(200, 150), whole(200, 150);
    render_node::EyeMemory memory;
    view.drawIfChanged(beside, inParts, memory);
    scene.terrain.setHeight(64, 30, 0);
    view.update(sand::GridData{scene.terrain}, sample::changeOf({64, 24, 72, 32}));
    const PixelRect drawn = view.drawIfChanged(beside, inParts, memory);
    EXPECT_LT(drawn.area(), 200 * 150);
    EXPECT_TRUE(inParts.read() == sample::draw(view, beside, whole));
}

// The changes of a session fade out before the edge of the rectangle that may change. Posts on level sand hide the sky
// as far away as sand can. So the test finds a rectangle that is two pixels too small on any side.
TEST_F(Redraw, ReachesAsFarAsAPostHidesTheSkyAndNotMuchFurther) {
    scene::Scene scene = sample::flatScene(128, 128);
    ScenePainter view(scene, glm::dmat4(1));
    const render_node::Camera above = sample::camera({1, 1, 2.2}, {1, 1, 0});
    const EyeTarget inParts(200, 150), whole(200, 150);
    render_node::EyeMemory memory;
    view.drawIfChanged(above, inParts, memory);
    Pixels before = inParts.read();
    int least = 1000;
    for (int i = 0; i < 24; ++i) {
        const int column = 30 + (i * 37) % 68, row = 40 + (i * 23) % 48;
        scene.terrain.setHeight(column, row, 5 * sand::kUnitsPerCell);
        view.update(sand::GridData{scene.terrain}, sample::changeOf({column - 7, row - 3, column + 5, row + 9}));
        const PixelRect drawn = view.drawIfChanged(above, inParts, memory);
        const Pixels now = sample::draw(view, above, whole);
        ASSERT_TRUE(inParts.read() == now) << "post " << i;
        ASSERT_LT(drawn.area(), 100 * 75) << "post " << i;
        least = std::min(least, slack(drawn, difference(before, now, 200), whole));
        before = now;
    }
    std::printf("the nearest change was %d pixels from the edge\n", least);
    EXPECT_LE(least, 2);
}

// Tests the usual sun, a sun in the zenith and a sun with long shadows. Also tests a sun that is too low for its
// shadows to be bounded closely.
TEST_F(Redraw, FollowsAToolHighAboveTheSandAndItsShadow) {
    for (const std::vector<double>& sun :
         std::vector<std::vector<double>>{scene::Look{}.sunDirection, {0, 0, 1}, {-0.6, 0.7, 0.3}, {0.9, -0.4, 0.1}}) {
        scene::Scene scene = sample::flatScene(128, 128, 0.05);
        scene.look.sunDirection = sun;
        ScenePainter view(scene, glm::dmat4(1));
        const render_node::Camera above = sample::camera({1, 1, 2.2}, {1, 1, 0});
        const EyeTarget inParts(200, 150), whole(200, 150);
        render_node::EyeMemory memory;
        view.drawIfChanged(above, inParts, memory);
        for (int i = 0; i < 40; ++i) {
            view.setTool(sample::probeAt(scene, {0.3 + 0.035 * i, 0.4 + 0.03 * i, 0.02 + 0.02 * i}), i % 2 == 0);
            const PixelRect drawn = view.drawIfChanged(above, inParts, memory);
            EXPECT_LT(drawn.area(), 200 * 150);
            ASSERT_TRUE(inParts.read() == sample::draw(view, above, whole)) << "sun " << sun[2] << ", place " << i;
        }
        EXPECT_TRUE(view.drawIfChanged(above, inParts, memory).empty());
    }
}

TEST_F(Redraw, FollowsAToolThatChangesItsSizeWhereItIs) {
    const scene::Scene scene = sample::flatScene(128, 128, 0.05);
    ScenePainter view(scene, glm::dmat4(1));
    const render_node::Camera above = sample::camera({1, 1, 2.2}, {1, 1, 0});
    const EyeTarget inParts(200, 150), whole(200, 150);
    render_node::EyeMemory memory;
    const sand::ProbePoint place = sample::probeAt(scene, {0.8, 0.9, 0.1});
    Pixels before;
    for (const double radius : {0.05, 0.12, 0.02, 0.08}) {
        const auto probes = static_cast<std::int32_t>(radius / scene.terrain.cellSize() * sand::kProbePerCell);
        view.setTool(place, true, {.radius = probes}, {});
        view.drawIfChanged(above, inParts, memory);
        const Pixels now = inParts.read();
        ASSERT_TRUE(now == sample::draw(view, above, whole)) << "radius " << radius;
        EXPECT_FALSE(now == before) << "radius " << radius;
        before = now;
    }
    EXPECT_TRUE(view.drawIfChanged(above, inParts, memory).empty());
}

// Tools of every shape are lifted, dragged, turned on the spot and switched while they are in the sand. They are also
// low over the rim, so that the boards take their shadow.
TEST_F(Redraw, FollowsToolsOfEveryShapeAsTheyTurnAndAreSwitched) {
    scene::Scene scene = sample::duneScene(128);
    scene.rules.toolRadius = static_cast<std::int32_t>(0.14 / scene.terrain.cellSize() * sand::kProbePerCell);
    sand::Replica terrain(scene);
    ScenePainter view(scene, glm::dmat4(1));
    const render_node::Camera slanted = sample::camera({1, -0.9, 1.3}, {1, 0.9, 0});
    const EyeTarget inParts(200, 150), whole(200, 150);
    render_node::EyeMemory memory;
    Tally tally;
    for (int i = 0; i < 120; ++i) {
        sand::Step step{.epoch = 1, .number = terrain.stepNumber() + 1, .engaged = i % 20 >= 6, .path = {}};
        const double along = (i % 40) / 40.0, height = step.engaged ? 0.16 : 0.3 + 0.02 * (i % 20);
        const int row = i / 20;
        if (i % 20 < 15) {
            step.path = {sample::probeAt(scene, {0.3 + 1.75 * along, 0.5 + 0.1 * row, height})};
        }
        step.heading = sand::headingOf(7.0 * i, i % 3 == 0);
        if (i % 10 == 8) {
            sand::Tuning tuning = scene.rules.tuning();
            tuning.toolKind = static_cast<sand::ToolKind>((i / 10) % sand::kToolKinds);
            tuning.toolHalfWidth = sand::isRound(tuning.toolKind) ? 0 : tuning.toolRadius / 3;
            step.edit = sand::Edit::tuned(tuning);
        }
        terrain.apply(step);
        view.update(terrain.surface().data(), terrain.takeChange());
        view.setTool(terrain.probe(), terrain.engaged(), terrain.toolShape(), terrain.heading());
        const PixelRect drawn = view.drawIfChanged(slanted, inParts, memory);
        (drawn.empty() ? tally.skipped : drawn.area() < 200 * 150 ? tally.inPart : tally.whole) += 1;
        ASSERT_TRUE(inParts.read() == sample::draw(view, slanted, whole))
            << sand::toolName(terrain.toolShape().kind) << " in step " << i;
    }
    EXPECT_GT(tally.inPart, 60);
}

TEST_F(Redraw, OfRestingSandDrawsNothing) {
    const scene::Scene scene = sample::flatScene(64, 64);
    sand::Replica terrain(scene);
    ScenePainter view(scene, glm::dmat4(1));
    const render_node::Camera above = sample::camera({1, 1, 2.2}, {1, 1, 0});
    const EyeTarget target(200, 150);
    render_node::EyeMemory memory;
    for (int i = 0; i < 5; ++i) {
        terrain.apply({0, terrain.stepNumber() + 1, false, {}});
        view.update(terrain.surface().data(), terrain.takeChange());
        view.setTool(terrain.probe(), terrain.engaged());
        EXPECT_EQ(view.drawIfChanged(above, target, memory).empty(), i > 0) << "frame " << i;
    }
}

}  // namespace
