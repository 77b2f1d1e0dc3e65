// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <glm/glm.hpp>
#include <string_view>
#include <vector>

#include "render_node/gl/eye_target.hpp"
#include "render_node/gl/gl_program.hpp"

namespace render_node {

/// Rectangles and words of one colour each, later ones over earlier ones: what test patterns are painted with.
///
/// Places are whole pixels from the top left of the target, colours sRGB from 0 to 1. What does not fit is cut off.
/// Needs its context current; one thread.
class FlatPainter {
public:
    /// Throws std::runtime_error when the shader does not compile.
    FlatPainter();

    void addBox(glm::ivec2 topLeft, glm::ivec2 size, glm::vec3 colour);
    /// A hollow box whose sides are `thick` pixels.
    void addFrame(glm::ivec2 topLeft, glm::ivec2 size, int thick, glm::vec3 colour);
    /// Dots of `dot` pixels; see dot_font.hpp.
    void addText(std::string_view text, glm::ivec2 topLeft, int dot, glm::vec3 colour);

    /// Paints over what the target shows and forgets what was added.
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

/// Size of a text with dots of one pixel [pixel].
[[nodiscard]] glm::ivec2 textSize(std::string_view text);
/// The largest dots with which a text fits into a box, at least 1 [pixel].
[[nodiscard]] int dotToFit(std::string_view text, glm::ivec2 box);

}  // namespace render_node
