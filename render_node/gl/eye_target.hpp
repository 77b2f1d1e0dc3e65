// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "render_node/gl/gl_handle.hpp"

namespace render_node {

/// Picture of a tile in its own frame buffer. The pixels stay from frame to frame, while a window's back buffer is
/// undefined after a swap.
///
/// The picture is either the view of one eye, with depth, or an output that is composed from both eyes, without depth.
/// Used by the thread of its context.
class EyeTarget {
public:
    enum class Depth : std::uint8_t { tested, none };

    /// Throws std::runtime_error if the driver refuses the size. The message contains the size.
    EyeTarget(int width, int height /* [pixel] */, Depth depth = Depth::tested);

    [[nodiscard]] int width() const { return width_; }    // [pixel]
    [[nodiscard]] int height() const { return height_; }  // [pixel]
    [[nodiscard]] GLuint framebuffer() const { return framebuffer_.id(); }
    /// Returns the colours as a texture without mipmaps. Texel (0, 0) is at the lower left.
    [[nodiscard]] GLuint colour() const { return colour_.id(); }
    /// Returns the memory in GL [byte]: 4 bytes per pixel for colour, and 4 bytes more for depth.
    [[nodiscard]] std::int64_t bytes() const;

    /// Makes this the target of all further drawing, and sets the viewport to its size.
    void bind() const;
    /// Waits until everything that this context has drawn so far is in the pixels.
    void finish() const { glFinish(); }
    /// Returns the pixels as 8-bit sRGB: three bytes per pixel, row by row without padding, top row first. Waits for
    /// the drawing.
    [[nodiscard]] std::vector<std::uint8_t> read() const;

private:
    int width_, height_;
    GlTexture colour_;
    std::optional<GlRenderbuffer> depth_;
    GlFramebuffer framebuffer_;
};

}  // namespace render_node
