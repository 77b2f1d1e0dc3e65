// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "render_node/gl/gl_handle.hpp"

namespace render_node {

/// A picture of a tile in a frame buffer of its own, which keeps its pixels from frame to frame (a window's back
/// buffer is undefined after a swap): what one eye sees, with depth, or an output put together from both eyes, without.
///
/// Lives on the thread of its context.
class EyeTarget {
public:
    enum class Depth : std::uint8_t { tested, none };

    /// Throws std::runtime_error when the driver refuses the size, with the size in the message.
    EyeTarget(int width, int height /* [pixel] */, Depth depth = Depth::tested);

    [[nodiscard]] int width() const { return width_; }    // [pixel]
    [[nodiscard]] int height() const { return height_; }  // [pixel]
    [[nodiscard]] GLuint framebuffer() const { return framebuffer_.id(); }
    /// Its colours as a texture without mipmaps; texel (0, 0) is at the lower left.
    [[nodiscard]] GLuint colour() const { return colour_.id(); }
    /// What it holds in GL's memory: 4 bytes a pixel for colour, 4 more for depth.
    [[nodiscard]] std::int64_t bytes() const;

    /// Makes it the target of what is drawn next, viewport included.
    void bind() const;
    /// Waits until everything drawn so far, on this context, is in its pixels.
    void finish() const { glFinish(); }
    /// 8-bit sRGB, three bytes a pixel, row by row without padding, top row first. Waits for the drawing.
    [[nodiscard]] std::vector<std::uint8_t> read() const;

private:
    int width_, height_;
    GlTexture colour_;
    std::optional<GlRenderbuffer> depth_;
    GlFramebuffer framebuffer_;
};

}  // namespace render_node
