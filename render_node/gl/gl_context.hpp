// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

namespace render_node {

/// What gives this process OpenGL. One file per backend; the rest of the program does not know which it is.
enum class Backend { osmesa };

/// An OpenGL 3.3 core context, current on the thread that made it and used by that thread alone.
///
/// Everything that holds GL objects (EyeTarget, SandView) must be destroyed before its context is.
class GlContext {
public:
    GlContext() = default;
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;
    virtual ~GlContext() = default;

    virtual void makeCurrent() = 0;
    [[nodiscard]] virtual std::string name() const = 0;  // as --gl takes it: "osmesa"
    /// What draws, as GL_RENDERER and GL_VERSION name it. The context must be current.
    [[nodiscard]] std::string renderer() const;
};

/// Makes a context, current on this thread, with the GL functions loaded. Throws files::InputError in one line that
/// says what to install or to choose instead.
[[nodiscard]] std::unique_ptr<GlContext> makeContext(Backend backend);

// One per backend, in the file of its name.
[[nodiscard]] std::unique_ptr<GlContext> makeOsmesaContext();

}  // namespace render_node
