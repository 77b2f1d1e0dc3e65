// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "render_node/gl/gl_handle.hpp"

namespace render_node {

/// The picture of one eye of a tile: colour and depth in a frame buffer of its own, which keeps its pixels from frame
/// to frame (a window's back buffer is undefined after a swap).
///
/// Lives on the thread of its context.
class EyeTarget {
public:
    /// Throws std::runtime_error when the driver refuses the size, with the size in the message.
    EyeTarget(int width, int height /* [pixel] */);

    [[nodiscard]] int width() const { return width_; }    // [pixel]
    [[nodiscard]] int height() const { return height_; }  // [pixel]
    [[nodiscard]] GLuint framebuffer() const { return framebuffer_.id(); }

    /// Makes it the target of what is drawn next, viewport included.
    void bind() const;
    /// Waits until everything drawn so far, on this context, is in its pixels.
    void finish() const { glFinish(); }
    /// 8-bit sRGB, three bytes a pixel, row by row without padding, top row first. Waits for the drawing.
    [[nodiscard]] std::vector<std::uint8_t> read() const;

private:
    int width_, height_;
    GlRenderbuffer colour_, depth_;
    GlFramebuffer framebuffer_;
};

}  // namespace render_node
