// SPDX-License-Identifier: Apache-2.0
// Sand that moves is drawn more coarsely. Each frame is drawn in parts and whole, and by a rank that was healed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <random>
#include <vector>

#include "sand/grid/dunes.hpp"
#include "scene/model/scene.hpp"
#include "shapes/model/sharpening.hpp"
#include "tests/sand/spread/sessions.hpp"
#include "tests/support/pictures/redraw_fixture.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/seed.hpp"

namespace {

using render_node::Camera;
using render_node::ScenePainter;
using sample::Pixels;
using sample::TwiceDrawn;

/// Returns a field with two levels above level 0, a needle, and a heap that slides.
scene::Scene slidingScene(int stepsPerSecond) {
    scene::Scene scene = sample::flatScene(512, 256, 0.06);
    sand::grid::makeDunes({.height = 0.03, .length = 0.4}, scene.terrain);
    const int unit = sand::kUnitsPerCell;
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 512; ++x) {
            const double distance = std::hypot(x - 300, y - 140);
            const auto heap = static_cast<std::int32_t>(std::max(0.0, 40 - 1.2 * distance) * unit);
            scene.terrain.setHeight(x, y, scene.terrain.height(x, y) + heap);
        }
    }
    scene.terrain.setHeight(120, 60, 200 * unit);
    scene.rules.stepsPerSecond = stepsPerSecond;
    return scene;
}

class MovingSand : public sample::Redraw {
protected:
    /// Shows the sand on these tiles of a wall, whose pixels are divided by `reduction` along each side.
    void show(const std::string& wall, const std::vector<std::size_t>& tiles, walls::Stereo stereo, int stepsPerSecond,
              int reduction = 6) {
        scene_.emplace(slidingScene(stepsPerSecond));
        replica_.emplace(*scene_);
        wall_ = sample::reduced(walls::loadWall(sample::wallFolder() / (wall + ".toml")), reduction);
        viewer_ = wall_.viewer;
        const double width = scene_->terrain.columns() * scene_->terrain.cellSize();
        sceneToRoom_ = walls::stageToRoom(wall_.stage, width, width / 2,
                                          static_cast<double>(scene_->referenceHeight()) * scene_->terrain.unit());
        painter_.emplace(*scene_, sceneToRoom_);
        views_.clear();
        for (const std::size_t tile : tiles) {
            for (const walls::Eye eye : walls::eyesOf(stereo)) {
                views_.emplace_back(wall_.tiles.at(tile), eye);
            }
        }
    }
    void apply(sand::Step step) {
        step.number = replica_->stepNumber() + 1;
        replica_->apply(step);
    }
    [[nodiscard]] Camera cameraOf(const TwiceDrawn& view) const {
        const glm::dvec3 eye = walls::eyePosition(viewer_, view.eye);
        return {walls::viewOf(view.screen, eye, wall_.clip.near, wall_.clip.far).viewProjection, eye};
    }
    /// Draws a frame in parts and whole, and checks that both are equal.
    void draw() {
        painter_->update(replica_->surface().data(), replica_->takeChange());
        painter_->setTool(replica_->probe(), replica_->engaged());
        coarse_ = 0;
        for (TwiceDrawn& view : views_) {
            const Camera camera = cameraOf(view);
            const render_node::PixelRect drawn = painter_->drawIfChanged(camera, view.inParts, view.memory);
            const Pixels whole = sample::draw(*painter_, camera, view.whole);
            coarse_ += painter_->counts().coarseChunks;
            inPart_ += !drawn.empty() && drawn.area() < std::int64_t{view.whole.width()} * view.whole.height() ? 1 : 0;
            ASSERT_TRUE(view.inParts.read() == whole) << "step " << replica_->stepNumber();
        }
    }
    /// Returns the pictures of a rank that begins with this sand, in the order of the eyes.
    [[nodiscard]] std::vector<Pixels> picturesOf(const sand::Replica& replica, bool sharp) {
        ScenePainter fresh(*scene_, sceneToRoom_);
        fresh.update(replica.surface().data(), {});
        fresh.setTool(replica.probe(), replica.engaged());
        fresh.setSharp(sharp);
        std::vector<Pixels> pictures;
        for (TwiceDrawn& view : views_) {
            pictures.push_back(sample::draw(fresh, cameraOf(view), view.whole));
        }
        return pictures;
    }
    [[nodiscard]] std::vector<Pixels> pictures() const {
        std::vector<Pixels> drawn;
        for (const TwiceDrawn& view : views_) {
            drawn.push_back(view.inParts.read());
        }
        return drawn;
    }
    /// Returns a replica that was resumed from the state of another.
    [[nodiscard]] sand::Replica healed() const {
        sand::Replica other(*scene_);
        other.decodeState(replica_->encodeState());
        return other;
    }
    [[nodiscard]] sand::ProbePoint place(double x, double y, double z /* [cell] */) const {
        const auto probe = [](double cells) { return static_cast<std::int32_t>(cells * sand::kProbePerCell); };
        return {probe(x), probe(y), probe(z)};
    }

    std::optional<scene::Scene> scene_;
    std::optional<sand::Replica> replica_;
    walls::Wall wall_;
    walls::Viewer viewer_;
    glm::dmat4 sceneToRoom_{1};
    std::optional<ScenePainter> painter_;
    std::vector<TwiceDrawn> views_;
    int coarse_ = 0;  // chunks above level 0 in all whole pictures of the last draw()
    int inPart_ = 0;  // pictures that were drawn in part
};

// A picture of half as many pixels along each side cannot show the finest level. Two eyes may differ so, too.
TEST_F(MovingSand, OfAChunkIsMeasuredOnceForTwoPicturesThatShowOtherLevels) {
    show("desktop", {0}, walls::Stereo::mono, 60, 4);
    views_.emplace_back(sample::reduced(wall_, 2).tiles.at(0), walls::eyesOf(walls::Stereo::mono)[0]);
    painter_->setSharp(true);
    painter_->update(replica_->surface().data(), replica_->takeChange());
    painter_->setTool(replica_->probe(), replica_->engaged());
    std::vector<std::int64_t> measured;
    for (int round = 0; round < 3; ++round) {
        for (TwiceDrawn& view : views_) {
            (void)sample::draw(*painter_, cameraOf(view), view.whole);
            measured.push_back(painter_->work().measuredChunks);
        }
    }
    ASSERT_GT(measured[0], 0);
    ASSERT_GT(measured[1], measured[0]) << "the second picture has another finest level";
    EXPECT_EQ(measured.back(), measured[1]);
}

TEST_F(MovingSand, InARandomSessionIsDrawnInPartsAsAWhole) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    struct Session {
        const char* wall;
        std::vector<std::size_t> tiles;
        walls::Stereo stereo;
        int stepsPerSecond;
    };
    for (const Session& session : std::vector<Session>{{"desktop", {0}, walls::Stereo::mono, 60},
                                                       {"tiled_3x4", {5, 9}, walls::Stereo::passive, 1},
                                                       {"flex_cave", {1}, walls::Stereo::active, 1000}}) {
        show(session.wall, session.tiles, session.stereo, session.stepsPerSecond);
        const sand::Replica saved = *replica_;
        sand::ProbePoint hand = place(200, 100, 0);
        for (int frame = 0; frame < 90; ++frame) {
            for (unsigned steps = random() % 4; steps > 0; --steps) {
                sand::Step step{.engaged = frame % 30 < 12, .path = {hand}};
                hand.x += static_cast<std::int32_t>(random() % 6000) - 2600;
                hand.y += static_cast<std::int32_t>(random() % 6000) - 3000;
                if (random() % 4 == 0) {
                    step.edit = spread::randomStep(scene_->rules, saved, random).edit;
                }
                apply(step);
            }
            viewer_.eye += random() % 16 == 0 ? glm::dvec3(0.02, -0.01, 0.01) : glm::dvec3(0);
            painter_->setSharp(frame % 20 > 16);  // as in a pause
            draw();
            if (HasFatalFailure()) {
                return;
            }
            if (frame % 15 == 14) {
                ASSERT_EQ(picturesOf(healed(), frame % 20 > 16), pictures()) << "a healed rank, frame " << frame;
            }
        }
        EXPECT_GT(inPart_, 20);
    }
}

// A shape of a moving heap that has come to rest is drawn as if the rule did not exist.
TEST_F(MovingSand, ThatHasComeToRestIsSharpenedOverSomeFrames) {
    show("desktop", {0}, walls::Stereo::mono, 60, 3);  // with fewer pixels, sand at rest is as coarse
    draw();
    const int resting = coarse_;
    int most = 0;
    for (int i = 0; i < 30; ++i) {
        apply({.engaged = true, .path = {place(60 + 12 * i, 100, 2)}});
        draw();
        most = std::max(most, coarse_);
    }
    EXPECT_GT(most, resting) << "moving sand is drawn more coarsely";
    EXPECT_NE(picturesOf(*replica_, true), pictures());
    int frames = 0, changed = 0;
    for (bool sharp = false; !sharp && frames < 2000; ++frames) {
        apply({.engaged = false, .path = {place(200, 100, 400)}});
        if (!replica_->settled()) {
            continue;
        }
        const std::vector<Pixels> before = pictures();
        draw();
        changed += pictures() != before ? 1 : 0;
        const sand::Movement& movement = *replica_->surface().movement();
        sharp = shapes::Sharpening(60, movement.moved.size()).allSharp(movement);
    }
    ASSERT_LT(frames, 2000);
    EXPECT_GT(changed, 1);
    EXPECT_EQ(picturesOf(*replica_, true), pictures());
}

TEST_F(MovingSand, HasNoLevelsOfItsOwnInASceneThatDrawsEachCell) {
    show("desktop", {0}, walls::Stereo::mono, 60);
    scene_->look.detail = 0;
    painter_.emplace(*scene_, sceneToRoom_);
    for (int i = 0; i < 5; ++i) {
        apply({.engaged = true, .path = {place(60 + 12 * i, 100, 2)}});
    }
    draw();
    EXPECT_EQ(coarse_, 0);
}

}  // namespace
