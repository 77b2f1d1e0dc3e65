// SPDX-License-Identifier: Apache-2.0
// A painter draws only a part of each frame. Its pictures must equal whole drawings, in every stereo mode.
#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "render_node/overlay/help.hpp"
#include "render_node/tile_painter.hpp"
#include "tests/render_node/grid_and_desk.hpp"

namespace {

using pictures::Image;
using render_node::OutputPicture;
using render_node::PixelRect;
using render_node::TilePainter;
using sample::gridAndDesk;
using walls::Stereo;

class ChangedPixels : public sample::GridAndDesk {};

/// Returns whether two pictures are equal outside `rect`, which counts rows from the bottom.
bool equalOutside(const PixelRect& rect, const Image& a, const Image& b) {
    for (int y = 0; y < a.height; ++y) {
        const int row = a.height - 1 - y;
        for (int x = 0; x < a.width; ++x) {
            const bool inside = x >= rect.x0 && x < rect.x1 && row >= rect.y0 && row < rect.y1;
            const auto at = 3 * (static_cast<std::ptrdiff_t>(y) * a.width + x);
            if (!inside && !std::equal(a.rgb.begin() + at, a.rgb.begin() + at + 3, b.rgb.begin() + at)) {
                return false;
            }
        }
    }
    return true;
}

// A window of a software renderer shows only these pixels of a frame.
TEST_F(ChangedPixels, AreAllThatDiffersFromTheFrameBefore) {
    for (const auto& [stereo, name] : valuesOf(Stereo{})) {
        walls::Wall wall = gridAndDesk(stereo);
        wall.tiles[0].pixels = {640, 480};
        ASSERT_GT(render_node::helpSheet({0, 1, wall.tiles[0].pixels}, wall.tiles[0].pixels).size().y, 0);
        TilePainter painter(wall, wall.tiles[0], scene_, "host", sand::GridData{scene_.terrain});
        sand::Replica replica = dug(0);
        std::vector<Image> before;
        int inPart = 0, still = 0;
        for (std::uint64_t frame = 1; frame <= 24; ++frame) {
            lockstep::ViewState state = view();
            state.layers.set(lockstep::Overlay::help, frame >= 6 && frame < 14);
            state.layers.set(lockstep::Overlay::statistics, frame >= 9 && frame < 12);
            state.pattern = static_cast<std::uint8_t>(frame == 16 ? lockstep::Pattern::grid : lockstep::Pattern::none);
            if (frame % 4 != 0) {
                dig(replica);
            }
            std::vector<lockstep::Answer> answers;
            if (frame >= 4 && frame < 20) {
                answers.push_back({1, frame < 8 ? "tool: sphere" : "humidity 30 %"});
            }
            painter.paint(replica, state, frame, false, {}, answers);
            std::vector<Image> now;
            for (const OutputPicture& output : painter.outputs()) {
                now.push_back(sample::pictureOf(*output.picture));
            }
            const std::int64_t all = std::int64_t{now[0].width} * now[0].height;
            for (std::size_t i = 0; i < before.size(); ++i) {
                EXPECT_TRUE(equalOutside(painter.changed(), before[i], now[i])) << name << ", frame " << frame;
            }
            inPart += painter.changed().area() > 0 && painter.changed().area() < all ? 1 : 0;
            still += painter.changed().empty() ? 1 : 0;
            before = std::move(now);
        }
        EXPECT_GT(inPart, 6) << name;
        EXPECT_GT(still, 1) << name;
    }
}

/// Returns the eyes' pictures of a new painter, which draws all of them whole.
std::vector<Image> drawnAfresh(const walls::Wall& wall, const scene::Scene& scene, sand::Replica& replica,
                               const lockstep::ViewState& view) {
    TilePainter fresh(wall, wall.tiles[0], scene, "host", sand::GridData{scene.terrain});
    fresh.paint(replica, view, 1);
    std::vector<Image> pictures;
    for (const OutputPicture& output : fresh.outputs()) {
        pictures.push_back(sample::pictureOf(*output.picture));
    }
    return pictures;
}

// An answer comes and goes while sand moves below it, with and without help and wireframe.
TEST_F(ChangedPixels, LeaveNothingOfAnAnswerThatHasGone) {
    for (const Stereo stereo : {Stereo::mono, Stereo::anaglyphDubois, Stereo::passive}) {
        walls::Wall wall = gridAndDesk(stereo);
        wall.tiles[0].pixels = {640, 480};
        TilePainter painter(wall, wall.tiles[0], scene_, "host", sand::GridData{scene_.terrain});
        sand::Replica replica = dug(0);
        std::vector<Image> hidden, answered;
        for (std::uint64_t frame = 1; frame <= 12; ++frame) {
            lockstep::ViewState state = view();
            state.layers.set(lockstep::Overlay::help, frame >= 7);
            state.layers.set(lockstep::Overlay::wireframe, frame == 5);
            const bool answers = frame % 3 == 0;
            const std::vector<lockstep::Answer> all{{1, frame == 3 ? "undone" : "saved as saves/save_001.sand"}};
            if (frame % 2 == 0) {
                dig(replica);
            }
            painter.paint(replica, state, frame, false, {}, answers ? std::span(all) : std::span(all).first(0));
            std::vector<Image> now;
            for (const OutputPicture& output : painter.outputs()) {
                now.push_back(sample::pictureOf(*output.picture));
            }
            sand::Replica copy(scene_);
            copy.decodeState(replica.encodeState());
            EXPECT_EQ(now == drawnAfresh(wall, scene_, copy, state), !answers)
                << walls::stereoName(stereo) << ", frame " << frame;
        }
    }
}

}  // namespace
