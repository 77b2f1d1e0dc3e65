// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <glm/glm.hpp>
#include <string_view>
#include <vector>

#include "render_node/gl/eye_target.hpp"
#include "render_node/gl/gl_program.hpp"

namespace render_node {

/// Painter of rectangles and texts, each in one colour. Later ones cover earlier ones. Test patterns are painted with
/// it.
///
/// Places are whole pixels from the top left of the target. Colours are sRGB from 0 to 1. Parts outside the target are
/// cut off. The GL context must be current. Used by one thread.
class FlatPainter {
public:
    /// Throws std::runtime_error if the shader does not compile.
    FlatPainter();

    void addBox(glm::ivec2 topLeft, glm::ivec2 size, glm::vec3 colour);
    /// Adds a hollow box whose sides are `thick` pixels thick.
    void addFrame(glm::ivec2 topLeft, glm::ivec2 size, int thick, glm::vec3 colour);
    /// Adds a text in the font of dot_font.hpp. Each dot has `dot` × `dot` pixels.
    void addText(std::string_view text, glm::ivec2 topLeft, int dot, glm::vec3 colour);

    /// Paints the added shapes over the picture of `target`, and removes them from the painter.
    void paint(const EyeTarget& target);

private:
    struct Vertex {
        glm::vec2 at;  // [pixel]
        glm::vec3 colour;
    };
    GlProgram program_;
    GlVertexArray array_;
    GlBuffer buffer_;
    std::vector<Vertex> vertices_;
};

/// Returns the size of a text whose dots are one pixel wide [pixel].
[[nodiscard]] glm::ivec2 textSize(std::string_view text);
/// Returns the size of the largest dots with which a text fits into a box, at least 1 [pixel].
[[nodiscard]] int dotToFit(std::string_view text, glm::ivec2 box);

}  // namespace render_node
