// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glad/gl.h>

#include <string_view>

namespace render_node {

/// Keeps a software driver's memory small while many triangles are drawn. One thread, its context current.
///
/// llvmpipe keeps some 270 bytes for each triangle until it fills pixels, and much more for each draw call, in scenes
/// of 36 MB that it never returns: a field of 512 x 512 cells held 110 MB. Filling pixels more often bounds that, and
/// costs no time that can be measured.
class TrianglePace {
public:
    TrianglePace() {
        const GLubyte* renderer = glGetString(GL_RENDERER);
        software_ =
            renderer != nullptr && std::string_view(reinterpret_cast<const char*>(renderer)).starts_with("llvmpipe");
    }
    /// To be said behind each draw call.
    void drawn(int triangles) {
        waiting_ += triangles + kTrianglesPerDraw;
        if (software_ && waiting_ >= kTrianglesPerFinish) {
            glFinish();
            waiting_ = 0;
        }
    }

private:
    static constexpr int kTrianglesPerFinish = 32768;
    static constexpr int kTrianglesPerDraw = 128;  // which take as much as what else is kept of a draw call
    bool software_ = false;
    int waiting_ = 0;
};

}  // namespace render_node
