// SPDX-License-Identifier: Apache-2.0
#include "render_node/eye_target.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace render_node {

EyeTarget::EyeTarget(int width, int height) : width_(width), height_(height) {
    GLint most = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
    const std::string size = std::to_string(width) + " x " + std::to_string(height) + " pixels";
    if (width < 1 || height < 1 || width > most || height > most) {
        throw std::runtime_error("this OpenGL draws tiles of 1 to " + std::to_string(most) + " pixels a side, not " +
                                 size);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    glBindRenderbuffer(GL_RENDERBUFFER, colour_.id());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_.id());
    glBindRenderbuffer(GL_RENDERBUFFER, depth_.id());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.id());
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        throw std::runtime_error("this OpenGL gives no frame buffer of " + size);
    }
}

void EyeTarget::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    glViewport(0, 0, width_, height_);
}

std::vector<std::uint8_t> EyeTarget::read() const {
    const std::size_t rowBytes = 3 * static_cast<std::size_t>(width_);
    std::vector<std::uint8_t> pixels(rowBytes * static_cast<std::size_t>(height_));
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    // GL's first row is the lowest.
    for (std::size_t top = 0, bottom = static_cast<std::size_t>(height_) - 1; top < bottom; ++top, --bottom) {
        const auto row = [&](std::size_t index) {
            return pixels.begin() + static_cast<std::ptrdiff_t>(index * rowBytes);
        };
        std::swap_ranges(row(top), row(top + 1), row(bottom));
    }
    return pixels;
}

}  // namespace render_node
