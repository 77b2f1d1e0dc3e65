// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "render_node/gl/gl_context.hpp"
#include "render_node/scene_painter.hpp"
#include "tests/support/pictures/wall_painter.hpp"

namespace sample {

/// One eye of one tile: the picture that is drawn in parts, and the whole picture.
struct TwiceDrawn {
    walls::Screen screen;
    walls::Eye eye;
    render_node::EyeTarget inParts, whole;
    render_node::EyeMemory memory{};

    TwiceDrawn(const walls::Tile& tile, walls::Eye shown)
        : screen(tile.screen), eye(shown), inParts(tile.pixels.x, tile.pixels.y), whole(tile.pixels.x, tile.pixels.y) {}
};

/// Has the context for tests that draw one picture in parts and whole.
class Redraw : public testing::Test {
    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
};

}  // namespace sample
