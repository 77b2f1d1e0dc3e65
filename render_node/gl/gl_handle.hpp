// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glad/gl.h>

#include <utility>

namespace render_node {

/// Owner of one GL object. The context in which the object is made must be current when it is made and when it is
/// destroyed.
template <class Kind>
class GlHandle {
public:
    GlHandle() : id_(Kind::create()) {}
    GlHandle(GlHandle&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
    GlHandle& operator=(GlHandle&& other) noexcept {
        std::swap(id_, other.id_);
        return *this;
    }
    ~GlHandle() {
        if (id_ != 0) {
            Kind::destroy(id_);
        }
    }
    [[nodiscard]] GLuint id() const { return id_; }

private:
    GLuint id_;
};

struct BufferKind {
    static GLuint create() {
        GLuint id = 0;
        glGenBuffers(1, &id);
        return id;
    }
    static void destroy(GLuint id) { glDeleteBuffers(1, &id); }
};
struct VertexArrayKind {
    static GLuint create() {
        GLuint id = 0;
        glGenVertexArrays(1, &id);
        return id;
    }
    static void destroy(GLuint id) { glDeleteVertexArrays(1, &id); }
};
struct TextureKind {
    static GLuint create() {
        GLuint id = 0;
        glGenTextures(1, &id);
        return id;
    }
    static void destroy(GLuint id) { glDeleteTextures(1, &id); }
};
struct RenderbufferKind {
    static GLuint create() {
        GLuint id = 0;
        glGenRenderbuffers(1, &id);
        return id;
    }
    static void destroy(GLuint id) { glDeleteRenderbuffers(1, &id); }
};
struct FramebufferKind {
    static GLuint create() {
        GLuint id = 0;
        glGenFramebuffers(1, &id);
        return id;
    }
    static void destroy(GLuint id) { glDeleteFramebuffers(1, &id); }
};
struct ProgramKind {
    static GLuint create() { return glCreateProgram(); }
    static void destroy(GLuint id) { glDeleteProgram(id); }
};

/// Returns the size of so many entries of a buffer [byte].
template <class Entry, class Count>
GLsizeiptr bytesOf(Count entries) {
    return static_cast<GLsizeiptr>(entries) * static_cast<GLsizeiptr>(sizeof(Entry));
}

using GlBuffer = GlHandle<BufferKind>;
using GlVertexArray = GlHandle<VertexArrayKind>;
using GlTexture = GlHandle<TextureKind>;
using GlRenderbuffer = GlHandle<RenderbufferKind>;
using GlFramebuffer = GlHandle<FramebufferKind>;

}  // namespace render_node
