// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/names.hpp"
#include "render_node/gl/gl_platform.hpp"
#include "walls/wall.hpp"

namespace render_node {

class EyeTarget;

/// Source of a process's OpenGL context. Each backend is one loadable module; all other code is the same for every
/// backend.
enum class Backend : std::uint8_t {
    automatic,  // glfw if the wall file gives the tile a display, a monitor or a window's place; otherwise kInMemory
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

/// Pictures that one output shows in a frame: one picture, or both eyes' pictures if one window shows the eyes in turn.
struct OutputPicture {
    const EyeTarget* picture = nullptr;  // the only picture, or the left eye's
    const EyeTarget* right = nullptr;    // the right eye's picture; null unless the stereo mode is active
};

/// OpenGL 3.3 core context and, if the backend has windows, the windows of the tile.
///
/// The context is current on the thread that made it, and only that thread uses it. Objects that own GL objects
/// (EyeTarget, ScenePainter) must be destroyed before the context.
class GlContext {
public:
    GlContext() = default;
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;
    virtual ~GlContext() = default;

    virtual void makeCurrent() = 0;
    [[nodiscard]] virtual std::string name() const = 0;  // backend's name for --gl, such as "osmesa"
    /// Returns the renderer, from GL_RENDERER and GL_VERSION. The context must be current.
    [[nodiscard]] std::string renderer() const;

    /// Copies the pictures of the outputs, in the order of tile.outputs, to the windows' back buffers, and waits until
    /// GL has copied them. Off screen it only waits. Throws std::runtime_error, which names the output, if a window is
    /// lost.
    ///
    /// @param changed  Pixels that differ from the last call's pictures, in any output. A software renderer copies only
    ///                 these. The first call copies everything.
    /// @param frame    Number of the wall's frame. If the eyes are shown in turn, even frames show the left eye.
    virtual void present(std::span<const OutputPicture> outputs, const PixelRect& changed, std::uint64_t frame) = 0;
    /// Returns whether each frame shows only one eye. This is so for active stereo in windows without quad buffers.
    [[nodiscard]] virtual bool showsEyesInTurn() const { return false; }
    /// Shows the presented pictures. The caller swaps only after all ranks have agreed. Off screen it does nothing.
    virtual void swap() {}
    /// Returns the keys that were pressed in the windows since the last call, one character each. Off screen it returns
    /// "".
    [[nodiscard]] virtual std::string takeKeys() { return {}; }
    /// Returns the events of the pointer in the windows since the last call, in the order of time. Off screen, and for
    /// a context without the pointer, it returns none.
    [[nodiscard]] virtual std::vector<PointerEvent> takePointer() { return {}; }
    /// Waits for an event of the window system, at most `seconds` [s]. Off screen it returns at once.
    virtual void awaitEvents(double /* seconds */) {}
    /// Returns one line for the operator for each request of the wall file that this machine cannot meet.
    [[nodiscard]] virtual std::vector<std::string> shortcomings() const { return {}; }
    /// Returns whether hardware locks the swaps of several graphics cards. Off screen it returns "none". If only the
    /// windows of one card are locked, it returns "joined, no barrier". If all cards with a sync signal are locked, it
    /// returns "joined". Otherwise it returns "no extension" or "refused".
    [[nodiscard]] virtual std::string swapLock() const { return "none"; }
    /// Returns the number of first frames in which a hardware barrier settles. These frames do not count in the skew.
    [[nodiscard]] virtual int framesToIgnore() const { return 0; }
    /// Returns a lower bound of the memory of the windows' back buffers [byte].
    [[nodiscard]] virtual std::int64_t frameBufferBytes() const { return 0; }

protected:
    /// Waits for GL. After frames 1, 2, 4, 8 and so on, also returns the memory that compiling shaders has left.
    void finishFrame();
    [[nodiscard]] std::uint64_t framesFinished() const { return frames_; }

private:
    std::uint64_t frames_ = 0;
};

/// Makes a context for the outputs of `tile`, current on this thread, and loads the GL functions. Throws
/// base::InputError, with one line that gives the package to install or the backend to choose. With `pointer`, the
/// windows show the pointer and report its events; throws base::InputError if the backend has no windows.
[[nodiscard]] std::unique_ptr<GlContext> makeContext(Backend backend, const walls::Wall& wall, const walls::Tile& tile,
                                                     bool pointer = false);

/// Makes a context without outputs, as makeContext() does, for tests and measurements.
[[nodiscard]] std::unique_ptr<GlContext> makeOffscreenContext(Backend backend);

}  // namespace render_node
