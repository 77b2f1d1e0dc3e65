// SPDX-License-Identifier: Apache-2.0
#include "walls/stereo_change.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <memory>
#include <string>

#include "render_node/tile_painter.hpp"
#include "scene/model/scene.hpp"
#include "tests/render_node/small_wall.hpp"
#include "tests/support/pictures/sample_scene.hpp"

namespace {

using walls::Stereo;

walls::Wall smallWall() { return walls::shownIn(test::smallWall(), Stereo::anaglyphColour); }

using Pictures = std::vector<std::vector<std::uint8_t>>;

Pictures picturesOf(const render_node::TilePainter& painter) {
    Pictures pictures;
    for (const render_node::EyeTarget* target : painter.pictures()) {
        pictures.push_back(target->read());
    }
    return pictures;
}

// A tile that changes to a mode must show the same as a tile that was started in that mode. The test tries every pair
// of modes.
TEST(StereoChange, OfATileShowsWhatATileOfThatModeShows) {
    const auto context = render_node::makeOffscreenContext(render_node::Backend::automatic);
    const scene::Scene scene = sample::duneScene(48);
    const walls::Wall wall = smallWall();
    lockstep::ViewState view;
    std::copy_n(glm::value_ptr(wall.viewer.eye), 3, view.head.begin());
    view.eyeSeparation = 0.3;
    sand::Replica replica(scene);
    walls::Wall shown = wall;
    render_node::TilePainter painter(shown, shown.tiles[0], scene, "host", sand::GridData{scene.terrain});
    std::uint64_t frame = 0;
    painter.paint(replica, view, ++frame);
    for (const Stereo stereo : {Stereo::mono, Stereo::anaglyphDubois, Stereo::right, Stereo::checkerboard, Stereo::left,
                                Stereo::active, Stereo::anaglyphColour}) {
        shown = walls::shownOnItsOutputs(wall, stereo);
        painter.showAs(shown, shown.tiles[0]);
        painter.paint(replica, view, ++frame);
        render_node::TilePainter fresh(shown, shown.tiles[0], scene, "host", sand::GridData{scene.terrain});
        sand::Replica same(scene);
        fresh.paint(same, view, 1);
        EXPECT_EQ(picturesOf(painter), picturesOf(fresh)) << walls::stereoName(stereo);
        EXPECT_EQ(painter.frameBufferBytes(), fresh.frameBufferBytes()) << walls::stereoName(stereo);
        EXPECT_EQ(painter.outputs().size(), 1U);
    }
}

TEST(FrameBuffers, HoldTheEyesOfAModeAndWhatItComposesOfThem) {
    const auto context = render_node::makeOffscreenContext(render_node::Backend::automatic);
    const scene::Scene scene = sample::duneScene(48);
    const walls::Wall wall = smallWall();
    constexpr int kPixels = 80 * 60, kEye = 8, kColour = 4;  // [byte]: colour and depth, or colour alone
    const std::map<std::string, int> perPixel{{"mono", kEye},
                                              {"left", kEye},
                                              {"right", kEye},
                                              {"passive", 2 * kEye},
                                              {"active", 2 * kEye},
                                              {"side_by_side", 2 * kEye + 2 * kColour},
                                              {"top_bottom", 2 * kEye + 2 * kColour},
                                              {"row_interlaced", 2 * kEye + kColour},
                                              {"checkerboard", 2 * kEye + kColour},
                                              {"anaglyph", 2 * kEye + kColour},
                                              {"anaglyph_half", 2 * kEye + kColour},
                                              {"anaglyph_dubois", 2 * kEye + kColour}};
    for (const auto& [stereo, name] : valuesOf(walls::Stereo{})) {
        const walls::Wall shown = walls::shownIn(wall, stereo);
        const render_node::TilePainter painter(shown, shown.tiles[0], scene, "host", sand::GridData{scene.terrain});
        EXPECT_EQ(painter.frameBufferBytes(), perPixel.at(std::string(name)) * kPixels) << name;
    }
}

}  // namespace
