// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glad/gl.h>

#include <string_view>

namespace render_node {

/// Keeps the threads of a software driver busy while many triangles are drawn, and bounds its memory. Used by one
/// thread, with its context current.
///
/// llvmpipe fills pixels in threads of its own, but begins only at a flush. Calling glFlush() early lets it fill pixels
/// while this thread prepares the next triangles. With it, `draw_ms` of scripts/figures/sessions/pointer_latency.py
/// --json fell from 13.5 to 9.9 ms (median). Whole pictures (bench/draw) took the same time as before.
///
/// llvmpipe keeps some 270 bytes for each triangle, and much more for each draw call, until it fills pixels. It keeps
/// them in scenes of 36 MB that it never returns: a field of 512 × 512 cells held 110 MB. Calling glFinish() more often
/// bounds this memory and costs no measurable time.
class TrianglePace {
public:
    /// drawn() flushes after so many triangles, so that a software driver begins.
    static constexpr int kTrianglesPerFlush = 4096;

    TrianglePace() {
        const GLubyte* renderer = glGetString(GL_RENDERER);
        software_ =
            renderer != nullptr && std::string_view(reinterpret_cast<const char*>(renderer)).starts_with("llvmpipe");
    }
    /// Must be called after each draw call, with its number of triangles.
    void drawn(int triangles) {
        if (!software_) {
            return;
        }
        waiting_ += triangles + kTrianglesPerDraw;
        unflushed_ += triangles + kTrianglesPerDraw;
        if (waiting_ >= kTrianglesPerFinish) {
            glFinish();
            waiting_ = unflushed_ = 0;
        } else if (unflushed_ >= kTrianglesPerFlush) {
            glFlush();
            unflushed_ = 0;
        }
    }

private:
    static constexpr int kTrianglesPerFinish = 32768;
    // The other data of one draw call take as much memory as 128 triangles.
    static constexpr int kTrianglesPerDraw = 128;
    bool software_ = false;
    int waiting_ = 0, unflushed_ = 0;
};

}  // namespace render_node
