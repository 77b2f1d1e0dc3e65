// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/window_context.hpp"

#include <glad/gl.h>

#include <stdexcept>
#include <utility>

#include "render_node/gl/compiler_memory.hpp"
#include "render_node/gl/eye_target.hpp"

namespace render_node {
namespace {

/// Name of a picture's colour buffer. All contexts share textures and renderbuffers, but not frame buffer objects.
struct Colours {
    GLint object = 0;
    bool texture = false;
};

Colours coloursOf(const EyeTarget& picture) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, picture.framebuffer());
    const auto ask = [](GLenum key) {
        GLint value = 0;
        glGetFramebufferAttachmentParameteriv(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, key, &value);
        return value;
    };
    return {ask(GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME), ask(GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) == GL_TEXTURE};
}

/// Attaches a colour buffer for reading. This is done before every copy, because a context sees the changes of another
/// context only after attaching.
void attach(const Colours& colours) {
    const auto object = static_cast<GLuint>(colours.object);
    if (colours.texture) {
        glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, object, 0);
    } else {
        glFramebufferRenderbuffer(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, object);
    }
}

GLenum bufferOf(BackBuffer buffer) {
    return buffer == BackBuffer::left ? GL_BACK_LEFT : buffer == BackBuffer::right ? GL_BACK_RIGHT : GL_BACK;
}

/// Copies a picture to a buffer of another size. Both keep their top left corners, and the rest is black.
void copyToTopLeft(glm::ivec2 picture, glm::ivec2 buffer) {
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    const glm::ivec2 both = glm::min(picture, buffer);
    glBlitFramebuffer(0, picture.y - both.y, both.x, picture.y, 0, buffer.y - both.y, both.x, buffer.y,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);  // GL counts rows from the bottom
}

class WindowContext final : public GlContext {
public:
    WindowContext(Backend backend, std::unique_ptr<GlPlatform> platform, const std::vector<WindowRequest>& requests)
        : GlContext(backend, std::move(platform)),
          requests_(requests),
          readers_(requests.size()),
          changed_(requests.size()) {
        for (std::size_t i = 0; i < requests_.size(); ++i) {
            windows().makeCurrent(i);
            glGenFramebuffers(1, &readers_[i]);
            changed_[i] = allPixels(requests_[i].pixels);
            sizes_.push_back(requests_[i].pixels);
        }
        makeCurrent();
    }

    void present(std::span<const OutputPicture> outputs, const PixelRect& changed, std::uint64_t frame) override {
        if (outputs.size() != requests_.size()) {
            throw std::logic_error(std::to_string(outputs.size()) + " pictures for " +
                                   std::to_string(requests_.size()) + " windows in frame " + std::to_string(frame));
        }
        frame_ = frame;
        windows().check();
        glFinish();  // other contexts may read only finished pictures
        // From the last window to the first, so that the drawing context is current at the end.
        inTurn_ = outputs.front().right != nullptr && !windows().quadBuffers(0);
        for (std::size_t i = requests_.size(); i-- > 0;) {
            const bool resized = sizeOf(i) != std::exchange(sizes_[i], sizeOf(i));
            if (resized) {
                windows().resized(i);
            }
            const bool fits = glm::ivec2(outputs[i].picture->width(), outputs[i].picture->height()) == sizes_[i];
            const bool inPart = windows().keepsPicture(i) && outputs[i].right == nullptr && !resized && fits;
            changed_[i] = around(changed_[i], inPart ? changed : allPixels(sizes_[i]));
            if (!changed_[i].empty()) {
                show(i, copiesOf(outputs[i], windows().quadBuffers(i), frame));
            }
        }
        finishFrame();
    }
    [[nodiscard]] bool showsEyesInTurn() const override { return inTurn_; }
    void swap() override {
        for (std::size_t i = 0; i < requests_.size(); ++i) {
            if (windows().takeExposed(i)) {
                // The window may have grown since present(). Its back buffer has the size of then.
                changed_[i] = allPixels(sizes_[i]);
            }
        }
        windows().swap(frame_, changed_);
        changed_.assign(requests_.size(), {});
        windows().check();
    }
    [[nodiscard]] std::int64_t frameBufferBytes() const override {
        std::int64_t bytes = 0;
        for (std::size_t i = 0; i < requests_.size(); ++i) {
            bytes += std::int64_t{windows().quadBuffers(i) ? 8 : 4} * sizes_[i].x * sizes_[i].y;
        }
        return bytes;
    }

private:
    [[nodiscard]] glm::ivec2 sizeOf(std::size_t window) const {
        return requests_[window].follows ? windows().followedSize(window) : requests_[window].pixels;
    }
    void show(std::size_t window, const std::vector<Copy>& copies) {
        std::vector<Colours> sources;
        sources.reserve(copies.size());
        makeCurrent();
        for (const Copy& copy : copies) {
            sources.push_back(coloursOf(*copy.picture));
        }
        if (window != 0) {
            windows().makeCurrent(window);
        }
        // A scissor rectangle that is left from drawing would cut off the copy.
        const GLboolean scissor = glIsEnabled(GL_SCISSOR_TEST);
        glDisable(GL_SCISSOR_TEST);
        glBindFramebuffer(GL_READ_FRAMEBUFFER, readers_[window]);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
        for (std::size_t i = 0; i < copies.size(); ++i) {
            const EyeTarget& picture = *copies[i].picture;
            const glm::ivec2 size = sizes_[window];
            const glm::ivec2 pictureSize(picture.width(), picture.height());
            if (pictureSize != size && !requests_[window].follows) {
                throw std::logic_error("output " + requests_[window].output.name + " got a picture of " +
                                       std::to_string(picture.width()) + " x " + std::to_string(picture.height()));
            }
            attach(sources[i]);
            glDrawBuffer(bufferOf(copies[i].to));
            if (pictureSize == size) {
                const auto& [x0, y0, x1, y1] = changed_[window];
                glBlitFramebuffer(x0, y0, x1, y1, x0, y0, x1, y1, GL_COLOR_BUFFER_BIT, GL_NEAREST);
            } else {
                copyToTopLeft(pictureSize, size);
            }
        }
        if (scissor == GL_TRUE) {
            glEnable(GL_SCISSOR_TEST);
        }
        glFinish();
        if (framesFinished() == 0) {
            giveBackCompilerMemory();  // each window's context compiles its own copying shaders
        }
    }

    std::vector<WindowRequest> requests_;
    std::vector<glm::ivec2> sizes_;   // [pixel], of each window at the last present()
    std::vector<GLuint> readers_;     // one frame buffer object in each window's context, which destroys it
    std::vector<PixelRect> changed_;  // of each window, since its last swap
    std::uint64_t frame_ = 0;
    bool inTurn_ = false;  // known after the first frame
};

}  // namespace

std::vector<Copy> copiesOf(const OutputPicture& output, bool quadBuffers, std::uint64_t frame) {
    if (output.right == nullptr) {
        return {{output.picture, BackBuffer::only}};
    }
    if (quadBuffers) {
        return {{output.picture, BackBuffer::left}, {output.right, BackBuffer::right}};
    }
    return {{frame % 2 == 0 ? output.picture : output.right, BackBuffer::only}};
}

std::unique_ptr<GlContext> makeWindowContext(Backend backend, std::unique_ptr<GlPlatform> platform,
                                             const std::vector<WindowRequest>& windows) {
    return std::make_unique<WindowContext>(backend, std::move(platform), windows);
}

}  // namespace render_node
