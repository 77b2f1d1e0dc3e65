// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/grain_texture.hpp"

#include "shapes/model/grain.hpp"

namespace render_node {

// Each pixel reads one level. Interpolating between two levels took a fifth of a software renderer's whole drawing
// time.
GrainTexture::GrainTexture(const glm::vec2& sun) {
    glBindTexture(GL_TEXTURE_2D, texture_.id());
    GLint level = 0;
    GLsizei side = shapes::kGrainSide;
    for (const std::vector<std::uint8_t>& texels : shapes::grainLevels(sun)) {
        glTexImage2D(GL_TEXTURE_2D, level, GL_RGBA8, side, side, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
        ++level;
        side /= 2;
    }
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

void GrainTexture::bind(int unit) const {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, texture_.id());
}

}  // namespace render_node
