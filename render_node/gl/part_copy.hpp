// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render_node/gl/glx_loader.hpp"
#include "render_node/gl/pixel_rect.hpp"

namespace render_node {

/// Shows parts of a window's back buffer, and keeps the back buffer's picture. Uses GLX_MESA_copy_sub_buffer.
///
/// A software renderer copies each pixel of a frame with the processor, so that pixels which have not changed should
/// not be copied. A graphics card swaps whole buffers faster, and only a swap can wait for a retrace. So this class is
/// available only where GLX_MESA_query_renderer says that the renderer is not accelerated.
class PartCopy {
public:
    /// The context of `window` must be current.
    PartCopy(const GlxLoader& loader, GlxDrawable window);

    [[nodiscard]] bool available() const { return copy_ != nullptr; }
    /// Shows these pixels of the back buffer. Requires available().
    void show(const PixelRect& part) const;

private:
    using Copy = void (*)(void* display, GlxDrawable, int x, int y, int width, int height);

    void* display_;
    GlxDrawable window_;
    Copy copy_ = nullptr;
};

}  // namespace render_node
