// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/eye_target.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace render_node {

EyeTarget::EyeTarget(int width, int height, Depth depth) : width_(width), height_(height) {
    GLint mostTexels = 0, most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &mostTexels);
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
    most = std::min(most, mostTexels);
    const std::string size = std::to_string(width) + " x " + std::to_string(height) + " pixels";
    if (width < 1 || height < 1 || width > most || height > most) {
        throw std::runtime_error("this OpenGL draws tiles of 1 to " + std::to_string(most) + " pixels a side, not " +
                                 size);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    glBindTexture(GL_TEXTURE_2D, colour_.id());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_.id(), 0);
    if (depth == Depth::tested) {
        depth_.emplace();
        glBindRenderbuffer(GL_RENDERBUFFER, depth_->id());
        glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_->id());
    }
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        throw std::runtime_error("this OpenGL gives no frame buffer of " + size);
    }
}

std::int64_t EyeTarget::bytes() const { return std::int64_t{depth_ ? 8 : 4} * width_ * height_; }

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
    // GL's first row is the bottom row.
    for (std::size_t top = 0, bottom = static_cast<std::size_t>(height_) - 1; top < bottom; ++top, --bottom) {
        const auto row = [&](std::size_t index) {
            return pixels.begin() + static_cast<std::ptrdiff_t>(index * rowBytes);
        };
        std::swap_ranges(row(top), row(top + 1), row(bottom));
    }
    return pixels;
}

}  // namespace render_node
