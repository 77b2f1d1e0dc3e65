// SPDX-License-Identifier: Apache-2.0
#include "walls/window_size.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/type_ptr.hpp>
#include <random>

#include "render_node/tile_painter.hpp"
#include "scene/model/scene.hpp"
#include "tests/render_node/small_wall.hpp"
#include "tests/support/pictures/sample_scene.hpp"
#include "tests/support/seed.hpp"

namespace {

// A tile whose window changes its size while a hand digs must show what a tile of that size shows that was just
// started.
TEST(WindowSize, AfterAHundredChangesOfItWhileDiggingThePictureIsThatOfAFreshTile) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    const auto between = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
    const auto context = render_node::makeOffscreenContext(render_node::Backend::automatic);
    const scene::Scene scene = sample::duneScene(48);
    const walls::Wall wall = test::smallWall();
    lockstep::ViewState view;
    std::copy_n(glm::value_ptr(wall.viewer.eye), 3, view.head.begin());
    sand::Replica replica(scene);
    walls::Wall shown = wall;
    render_node::TilePainter painter(shown, shown.tiles[0], scene, "host", sand::GridData{scene.terrain});
    for (int change = 1; change <= 100; ++change) {
        shown = walls::shownInWindow(wall, {between(1, 150), between(1, 150)});
        painter.showAs(shown, shown.tiles[0]);
        for (int frame = 0; frame < 2; ++frame) {  // the second one draws only what has changed
            sand::Step step{1, replica.stepNumber() + 1, between(0, 3) > 0, {}};
            step.path.push_back(sample::probeAt(scene, {between(2, 18) * 0.1, between(2, 18) * 0.1, 0.05}));
            replica.apply(step);
            painter.paint(replica, view, replica.stepNumber());
        }
        if (change % 5 == 0) {
            render_node::TilePainter fresh(shown, shown.tiles[0], scene, "host", sand::GridData{scene.terrain});
            sand::Replica same(replica);
            fresh.paint(same, view, 1);
            ASSERT_EQ(painter.outputs()[0].picture->read(), fresh.outputs()[0].picture->read()) << "change " << change;
            EXPECT_EQ(painter.frameBufferBytes(), fresh.frameBufferBytes());
        }
    }
}

}  // namespace
