// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "render_node/gl/gl_context.hpp"
#include "tests/support/pictures/wall_painter.hpp"

namespace sample {

/// Has the context for tests that draw one picture in parts and whole.
class Redraw : public testing::Test {
    std::unique_ptr<render_node::GlContext> context_ =
        render_node::makeOffscreenContext(render_node::Backend::automatic);
};

}  // namespace sample
