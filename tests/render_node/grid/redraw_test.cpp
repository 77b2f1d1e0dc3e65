// SPDX-License-Identifier: Apache-2.0
// Sessions that are drawn twice, in parts and whole. Every frame must be equal in every byte.
#include <gtest/gtest.h>

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "render_node/tool/force.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/pictures/redraw_fixture.hpp"

namespace {

using lockstep::Overlay;
using render_node::EyeTarget;
using render_node::PixelRect;
using render_node::ScenePainter;
using sample::Pixels;
using sample::Redraw;

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
    scene.rules.tuning.tool.radius = static_cast<std::int32_t>(0.05 / scene.terrain.cellSize() * sand::kProbePerCell);
    return scene;
}

struct Twice : sample::TwiceDrawn {
    using TwiceDrawn::TwiceDrawn;
    Pixels before{};
};

/// Things that a step's frame shows in addition to the sand.
struct Shown {
    lockstep::Overlays layers;
    std::optional<render_node::ForceArrow> force;
    double humidity = 0;
};

using LayersAt = lockstep::Overlays (*)(int step);
lockstep::Overlays noLayers(int) { return {}; }
template <Overlay... layers>
lockstep::Overlays always(int) {
    lockstep::Overlays shown;
    (shown.set(layers, true), ...);
    return shown;
}

using HumidityAt = double (*)(int step);
double dry(int) { return 0; }

struct Tally {
    int skipped = 0, inPart = 0, whole = 0;
    double pixels = 0, all = 0;
};

/// Draws one eye both ways and compares the pictures. The first difference fails the test.
void drawTwice(ScenePainter& view, const walls::Wall& wall, const walls::Viewer& viewer, Twice& twice, Tally& tally) {
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
void checkAgainstFreshView(const scene::Scene& scene, const sand::Replica& replica, const glm::dmat4& sceneToRoom,
                           const Shown& shown, const render_node::Camera& camera, const Twice& twice) {
    ScenePainter fresh(scene, sceneToRoom);
    fresh.update(replica.surface().data(), {});
    fresh.setTool(replica.probe(), replica.engaged());
    fresh.setLayers(shown.layers);
    fresh.setForce(shown.force);
    fresh.setHumidity(shown.humidity);
    ASSERT_TRUE(sample::draw(fresh, camera, twice.whole) == twice.before);
}

/// Runs the whole session on these tiles of a wall, counted from 0. With `headMoves` the viewer moves every 23
/// steps.
Tally play(const std::string& name, int smaller, const std::vector<std::size_t>& tiles, sand::Rim rim, bool headMoves,
           walls::Stereo stereo, LayersAt layersAt = noLayers, HumidityAt humidityAt = dry) {
    walls::Wall wall = sample::reduced(walls::loadWall(sample::wallFolder() / (name + ".toml")), smaller);
    const scene::Scene scene = sessionScene(rim);
    sand::Replica replica(scene);
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
        replica.apply(stepOf(scene, i));
        view.update(replica.surface().data(), replica.takeChange());
        view.setTool(replica.probe(), replica.engaged());
        Shown shown{layersAt(i), force.arrow(replica), humidityAt(i)};
        shown.force = shown.layers.shows(Overlay::force) ? shown.force : std::nullopt;
        view.setLayers(shown.layers);
        view.setForce(shown.force);
        view.setHumidity(shown.humidity);
        if (headMoves && i % 23 == 22) {
            viewer.eye += glm::dvec3(0.03, -0.02, 0.01);
        }
        for (std::size_t at = 0; at < eyes.size(); ++at) {
            SCOPED_TRACE(name + ": step " + std::to_string(i) + ", eye " + std::to_string(at));
            drawTwice(view, wall, viewer, eyes[at], tally);
            if (testing::Test::HasFatalFailure()) {
                return tally;
            }
        }
        if (i % 40 == 39) {
            const glm::dvec3 position = walls::eyePosition(viewer, eyes[0].eye);
            const auto seen = walls::viewOf(eyes[0].screen, position, wall.clip.near, wall.clip.far);
            checkAgainstFreshView(scene, replica, sceneToRoom, shown, {seen.viewProjection, position}, eyes[0]);
        }
    }
    std::printf("%s: %d views skipped, %d drawn in part, %d whole; %.1f %% of the pixels\n", name.c_str(),
                tally.skipped, tally.inPart, tally.whole, 100 * tally.pixels / tally.all);
    return tally;
}

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

// The fresh view is compared in steps 39, 79, 119 and 159: dry again, wet, wetter and dry.
TEST_F(Redraw, WhileSandBecomesWetAndDryIsEqualToTheWhole) {
    const HumidityAt humidity = [](int step) {
        return step < 10 ? 0 : step < 30 ? 0.1 : step < 60 ? 0 : step < 100 ? 0.5 : step < 140 ? 1 : 0;
    };
    const Tally tally = play("desktop", 8, {0}, sand::Rim::closed, false, walls::Stereo::mono, noLayers, humidity);
    EXPECT_EQ(tally.whole, 1 + 5);
    EXPECT_GT(tally.inPart, kSteps / 3);
}

}  // namespace
