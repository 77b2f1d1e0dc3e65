// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/gl_context.hpp"

#include <glad/gl.h>

#include "files/input_error.hpp"

namespace render_node {

std::string GlContext::renderer() const {
    const auto text = [](GLenum key) {
        const GLubyte* words = glGetString(key);
        return words == nullptr ? std::string("?") : std::string(reinterpret_cast<const char*>(words));
    };
    return text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION);
}

void GlContext::present(std::span<const OutputPicture> /* outputs */, std::uint64_t /* frame */) { glFinish(); }

std::unique_ptr<GlContext> makeOffscreenContext(Backend backend) {
    switch (backend) {
        case Backend::osmesa:
            return makeOsmesaContext();
    }
    throw files::InputError("no such OpenGL backend");
}

std::unique_ptr<GlContext> makeContext(Backend backend, const walls::Wall& /* wall */, const walls::Tile& /* tile */) {
    return makeOffscreenContext(backend);
}

}  // namespace render_node
