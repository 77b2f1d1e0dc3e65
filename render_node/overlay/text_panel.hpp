// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "render_node/gl/eye_target.hpp"
#include "render_node/gl/gl_program.hpp"
#include "render_node/gl/pixel_rect.hpp"

namespace render_node {

class Sheet;

/// An opaque panel of text over a tile's picture, which never changes. It hides the picture below it. The GL context
/// must be current. Used by one thread.
class TextPanel {
public:
    /// Makes a panel of a sheet. `topLeft` is the place of its corner on the tile, which is `tileHeight` pixels high.
    TextPanel(const Sheet& sheet, glm::ivec2 topLeft /* [pixel] */, int tileHeight /* [pixel] */);

    /// Returns the pixels of a target that the panel covers; empty if the sheet has no size.
    [[nodiscard]] const PixelRect& pixels() const { return pixels_; }

private:
    friend class PanelPainter;
    PixelRect pixels_;
    GlTexture texture_;
};

/// Painter of text panels. It changes no depth. The GL context must be current. Used by one thread.
class PanelPainter {
public:
    /// Throws std::runtime_error if the shader does not compile.
    PanelPainter();

    /// Draws a panel. Drawing it again changes nothing.
    void draw(const TextPanel& panel, const EyeTarget& target) const;

private:
    GlProgram program_;
    GlVertexArray array_;
};

}  // namespace render_node
