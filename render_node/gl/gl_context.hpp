// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "walls/wall.hpp"

namespace render_node {

class EyeTarget;

/// What gives this process OpenGL. One loadable module per backend; the rest of the program does not know which it is.
enum class Backend : std::uint8_t {
    automatic,  // glfw for a tile whose wall file names a display, a monitor or a window's place, else osmesa
    osmesa,     // in memory: no display, no graphics card
    egl,        // off screen on a graphics card, or in Mesa's software renderer
    glfw        // windows on an X display
};
/// "auto", "osmesa", "egl", "glfw": as --gl takes them.
[[nodiscard]] std::string_view backendName(Backend backend);
/// The other way round. Throws base::InputError for any other word.
[[nodiscard]] Backend backendNamed(std::string_view name);
/// What `automatic` means for a tile; any other backend is itself.
[[nodiscard]] Backend backendFor(Backend backend, const walls::Tile& tile);

/// What one output shows in a frame: one picture, or both eyes' where one window shows them in turn.
struct OutputPicture {
    const EyeTarget* picture = nullptr;  // the only one, or the left eye's
    const EyeTarget* right = nullptr;    // null unless the stereo is active
};

/// An OpenGL 3.3 core context, current on the thread that made it and used by that thread alone, and the windows of
/// the tile where it has some.
///
/// Everything that holds GL objects (EyeTarget, ScenePainter) must be destroyed before its context is.
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

    /// Copies the outputs' pictures, in the order of tile.outputs, to where the screens will take them from, and waits
    /// until GL has done so. `frame` is the wall's: with eyes in turn, even frames show the left one. Off screen it
    /// only waits. Throws std::runtime_error when a window is lost, with its output in the message.
    virtual void present(std::span<const OutputPicture> outputs, std::uint64_t frame) = 0;
    /// Whether a frame shows one eye alone: active stereo in windows without quad buffers.
    [[nodiscard]] virtual bool showsEyesInTurn() const { return false; }
    /// Shows what was presented; nobody swaps before all ranks have agreed. Nothing off screen.
    virtual void swap() {}
    /// The keys pressed in the windows since the last call, one character each. None off screen.
    [[nodiscard]] virtual std::string takeKeys() { return {}; }
    /// What the wall file asks for and this machine cannot do, one line each, for the operator.
    [[nodiscard]] virtual std::vector<std::string> shortcomings() const { return {}; }
    /// Whether the swaps of several graphics cards are locked in hardware: "none" off screen, "no extension",
    /// "refused", "joined, no barrier" (the windows of one card), "joined" (all cards with a sync signal).
    [[nodiscard]] virtual std::string swapLock() const { return "none"; }
    /// How many frames from the start a hardware barrier needs to settle: they do not count in the skew.
    [[nodiscard]] virtual int framesToIgnore() const { return 0; }
    /// Of the windows' own back buffers, at the least [byte].
    [[nodiscard]] virtual std::int64_t frameBufferBytes() const { return 0; }

protected:
    /// Waits for GL; now and then, the first time after the first frame, gives back what compiling shaders has left.
    void finishFrame();
    [[nodiscard]] std::uint64_t framesFinished() const { return frames_; }

private:
    std::uint64_t frames_ = 0;
};

/// Makes a context for the outputs of a tile, current on this thread, with the GL functions loaded. Throws
/// base::InputError in one line that says what to install or to choose instead.
[[nodiscard]] std::unique_ptr<GlContext> makeContext(Backend backend, const walls::Wall& wall, const walls::Tile& tile);

/// The same without any output: for tests and measurements.
[[nodiscard]] std::unique_ptr<GlContext> makeOffscreenContext(Backend backend);

}  // namespace render_node
