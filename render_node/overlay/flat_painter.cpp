// SPDX-License-Identifier: Apache-2.0
#include "render_node/overlay/flat_painter.hpp"

#include <algorithm>
#include <cstddef>

#include "render_node/gl/vertex_attribute.hpp"
#include "render_node/overlay/dot_font.hpp"

namespace render_node {

FlatPainter::FlatPainter() : program_(shaderSource("flat.vert.glsl"), ShaderSource{}, shaderSource("flat.frag.glsl")) {
    glBindVertexArray(array_.id());
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.id());
    describeAttribute<Vertex>(0, 2, GL_FLOAT, GL_FALSE, offsetof(Vertex, at));
    describeAttribute<Vertex>(1, 3, GL_FLOAT, GL_FALSE, offsetof(Vertex, colour));
}

void FlatPainter::addBox(glm::ivec2 topLeft, glm::ivec2 size, glm::vec3 colour) {
    const glm::vec2 low(topLeft), high(topLeft + size);
    const auto corner = [&](float x, float y) { vertices_.push_back({{x, y}, colour}); };
    corner(low.x, low.y);
    corner(low.x, high.y);
    corner(high.x, high.y);
    corner(low.x, low.y);
    corner(high.x, high.y);
    corner(high.x, low.y);
}

void FlatPainter::addFrame(glm::ivec2 topLeft, glm::ivec2 size, int thick, glm::vec3 colour) {
    addBox(topLeft, {size.x, thick}, colour);
    addBox({topLeft.x, topLeft.y + size.y - thick}, {size.x, thick}, colour);
    addBox(topLeft, {thick, size.y}, colour);
    addBox({topLeft.x + size.x - thick, topLeft.y}, {thick, size.y}, colour);
}

void FlatPainter::addText(std::string_view text, glm::ivec2 topLeft, int dot, glm::vec3 colour) {
    for (const char letter : text) {
        const auto rows = glyphOf(letter);
        for (int y = 0; y < kGlyphHeight; ++y) {
            const auto dark = [row = rows[static_cast<std::size_t>(y)]](int x) {
                return ((row >> (kGlyphWidth - 1 - x)) & 1) == 0;
            };
            for (int x = 0; x < kGlyphWidth; ++x) {
                const int from = x;
                while (x < kGlyphWidth && !dark(x)) {
                    ++x;
                }
                if (x > from) {  // dots side by side are one box
                    addBox(topLeft + glm::ivec2(from, y) * dot, {(x - from) * dot, dot}, colour);
                }
            }
        }
        topLeft.x += kGlyphPitch * dot;
    }
}

void FlatPainter::paint(const EyeTarget& target) {
    target.bind();
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    program_.use();
    program_.set("uSize", glm::vec2(target.width(), target.height()));
    glBindVertexArray(array_.id());
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.id());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices_.size() * sizeof(Vertex)), vertices_.data(),
                 GL_STREAM_DRAW);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices_.size()));
    program_.drawn();
    vertices_.clear();
}

glm::ivec2 textSize(std::string_view text) {
    const int letters = static_cast<int>(text.size());
    return {std::max(0, letters * kGlyphPitch - 1), kGlyphHeight};
}

int dotToFit(std::string_view text, glm::ivec2 box) {
    const glm::ivec2 size = glm::max(textSize(text), glm::ivec2(1));
    return std::max(1, std::min(box.x / size.x, box.y / size.y));
}

}  // namespace render_node
