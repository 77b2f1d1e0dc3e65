// SPDX-License-Identifier: Apache-2.0
#include "render_node/overlay/text_panel.hpp"

#include <vector>

#include "render_node/overlay/letters.hpp"

namespace render_node {
namespace {

/// Returns the rows of a sheet from the bottom to the top, as GL has them.
std::vector<std::uint8_t> fromBelow(const Sheet& sheet) {
    const auto row = 3 * static_cast<std::ptrdiff_t>(sheet.size().x);
    std::vector<std::uint8_t> turned;
    turned.reserve(sheet.rgb().size());
    for (std::ptrdiff_t y = sheet.size().y - 1; y >= 0; --y) {
        turned.insert(turned.end(), sheet.rgb().begin() + y * row, sheet.rgb().begin() + (y + 1) * row);
    }
    return turned;
}

}  // namespace

TextPanel::TextPanel(const Sheet& sheet, glm::ivec2 topLeft, int tileHeight)
    : pixels_{topLeft.x, tileHeight - topLeft.y - sheet.size().y, topLeft.x + sheet.size().x, tileHeight - topLeft.y} {
    if (pixels_.empty()) {
        return;
    }
    constexpr GLint kUsualAlignment = 4;
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, texture_.id());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, sheet.size().x, sheet.size().y, 0, GL_RGB, GL_UNSIGNED_BYTE,
                 fromBelow(sheet).data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, kUsualAlignment);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

PanelPainter::PanelPainter()
    : program_(shaderSource("whole.vert.glsl"), ShaderSource{}, shaderSource("panel.frag.glsl")) {}

void PanelPainter::draw(const TextPanel& panel, const EyeTarget& target) const {
    const PixelRect& pixels = panel.pixels();
    if (pixels.empty()) {
        return;
    }
    target.bind();
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    program_.use();
    program_.set("uPanel", 0);
    program_.set("uCorner", glm::ivec2(pixels.x0, pixels.y0));
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, panel.texture_.id());
    glBindVertexArray(array_.id());
    glEnable(GL_SCISSOR_TEST);
    glScissor(pixels.x0, pixels.y0, pixels.x1 - pixels.x0, pixels.y1 - pixels.y0);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    program_.drawn();
    glDisable(GL_SCISSOR_TEST);
}

}  // namespace render_node
