// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>

#include "base/names.hpp"
#include "render_node/gl/gl_platform.hpp"
#include "walls/wall.hpp"

namespace render_node {

class EyeTarget;

/// Source of a process's OpenGL context. Each backend is one loadable module; all other code is the same for every
/// backend.
enum class Backend : std::uint8_t {
    automatic,  // glfw if the wall file names a display, a monitor or a window's place for the tile; else kInMemory
    osmesa,     // draws into memory, without a display or a graphics card
    egl,        // draws off screen on a graphics card or in Mesa's software renderer
    glfw        // windows on an X display
};
constexpr auto valuesOf(Backend) {
    return std::array{base::Named{Backend::automatic, "auto"}, base::Named{Backend::osmesa, "osmesa"},
                      base::Named{Backend::egl, "egl"}, base::Named{Backend::glfw, "glfw"}};
}
/// Backend that draws in memory, which every machine can: osmesa, or egl on its software device in a build without
/// OSMesa.
extern const Backend kInMemory;
/// Returns the backend that `automatic` chooses for `tile`. Returns every other backend unchanged.
[[nodiscard]] Backend backendFor(Backend backend, const walls::Tile& tile);

/// Pictures that one output shows in a frame. There are two if one window shows the eyes in turn, and otherwise one.
/// "Left" and "right" are those of the display. If the wall swaps eyes, the display's left is the right eye's picture.
struct OutputPicture {
    const EyeTarget* picture = nullptr;  // the only picture, or the left one
    const EyeTarget* right = nullptr;    // the right picture; null unless the stereo mode is active
};

/// OpenGL 3.3 core context. It draws off screen; WindowContext shows its pictures in windows.
///
/// The context is current on the thread that made it, and only that thread uses it. Destroy objects that own GL
/// objects, such as EyeTarget and ScenePainter, before the context.
class GlContext {
public:
    /// Makes context 0 of `platform` current, and loads OpenGL's functions through it. Throws base::InputError if one
    /// is missing.
    GlContext(Backend backend, std::unique_ptr<GlPlatform> platform);
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;
    virtual ~GlContext() = default;

    void makeCurrent() { platform_->makeCurrent(0); }
    [[nodiscard]] std::string name() const;  // backend's name for --gl, such as "osmesa"
    /// Returns the renderer, from GL_RENDERER and GL_VERSION. The context must be current.
    [[nodiscard]] std::string renderer() const;
    /// Returns the platform, for the events and the properties of its windows.
    [[nodiscard]] GlPlatform& windows() const { return *platform_; }

    /// Copies the pictures of the outputs to the back buffers of the windows, and waits until GL has copied them. Off
    /// screen, only waits until GL has drawn them. Throws std::runtime_error, which names the output, if a window is
    /// lost.
    ///
    /// @param outputs  Pictures in the order of tile.outputs. A picture that follows its window may have another size
    ///                 than the window, which may have changed since. It then begins at the window's top left corner.
    /// @param changed  Pixels that differ from the last call's pictures, in any output. A software renderer copies only
    ///                 these. The first call copies everything.
    /// @param frame    Number of the wall's frame. If the eyes are shown in turn, even frames show the left eye.
    virtual void present(std::span<const OutputPicture> outputs, const PixelRect& changed, std::uint64_t frame);
    /// Returns true for active stereo in windows without quad buffers: each frame then shows one eye.
    [[nodiscard]] virtual bool showsEyesInTurn() const { return false; }
    /// Shows the presented pictures. Call it after all ranks have agreed.
    virtual void swap() {}
    /// Returns a lower bound of the memory of the windows' back buffers [byte].
    [[nodiscard]] virtual std::int64_t frameBufferBytes() const { return 0; }

protected:
    /// Waits until GL has drawn everything. After frames 1, 2, 4, 8 and so on, also gives the memory that the compiler
    /// of shaders has left back to the system.
    void finishFrame();
    [[nodiscard]] std::uint64_t framesFinished() const { return frames_; }

private:
    Backend backend_;
    std::unique_ptr<GlPlatform> platform_;
    std::uint64_t frames_ = 0;
};

/// Makes a context for the outputs of `tile`, current on this thread, and loads the GL functions. Throws
/// base::InputError, whose line names the package to install or the backend to choose.
///
/// @param pointer    Whether the windows show the pointer and report its events. Throws base::InputError if it is true
///                   and the backend has no windows.
/// @param sceneName  Shown in the titles of the windows.
[[nodiscard]] std::unique_ptr<GlContext> makeContext(Backend backend, const walls::Wall& wall, const walls::Tile& tile,
                                                     bool pointer = false, const std::string& sceneName = {});

/// Makes a context without outputs, as makeContext() does, for tests and measurements.
[[nodiscard]] std::unique_ptr<GlContext> makeOffscreenContext(Backend backend);

}  // namespace render_node
