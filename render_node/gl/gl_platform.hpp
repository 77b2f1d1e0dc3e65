// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "walls/wall.hpp"

namespace render_node {

using GlFunction = void (*)();

/// A window to open: an output, and the size of what it shows.
struct WindowRequest {
    walls::Output output;
    glm::ivec2 pixels{1, 1};
};

/// What a backend is asked for. No windows: OpenGL off screen.
struct PlatformRequest {
    std::string who = "this process";  // "rank 3 (r1c3)": begins the last line of a process whose X server is gone
    std::string display;               // X display; empty: $DISPLAY
    int device = -1;                   // EGL device; -1: the driver's choice
    bool eyesInTurn = false;           // active stereo: quad buffers, else frame by frame
    double refreshHz = 60;
    std::vector<WindowRequest> windows;
};

/// What a backend's module gives: contexts and windows, but no drawing, so that OpenGL's functions are loaded once, by
/// the program. Used by one thread. Constants and pure virtual functions only: a module needs no symbol of the program.
class GlPlatform {
public:
    GlPlatform() = default;
    GlPlatform(const GlPlatform&) = delete;
    GlPlatform& operator=(const GlPlatform&) = delete;
    virtual ~GlPlatform() = default;

    /// Context 0 draws the pictures and shows window 0; the others share its objects and show one window each. Throws
    /// base::InputError when the driver refuses.
    virtual void makeCurrent(std::size_t context) = 0;
    [[nodiscard]] virtual GlFunction functionNamed(const char* name) = 0;

    // Windows. Off screen there are none, and none of the rest is called.
    [[nodiscard]] virtual bool quadBuffers(std::size_t /* window */) const { return false; }
    /// Takes in what the window system has to say. Throws std::runtime_error with the output's name when a window is
    /// lost.
    virtual void check() {}
    /// Swaps all windows. `frame` is the wall's, for eyes in turn.
    virtual void swap(std::uint64_t /* frame */) {}
    [[nodiscard]] virtual std::string takeKeys() { return {}; }
    [[nodiscard]] virtual std::vector<std::string> shortcomings() const { return {}; }
    [[nodiscard]] virtual std::string swapLock() const { return "none"; }
    [[nodiscard]] virtual int framesToIgnore() const { return 0; }
};

/// The one symbol of a module, by this name; the number changes with this header. Throws base::InputError.
extern "C" GlPlatform* sandwallGlPlatform1(const PlatformRequest& request);
inline constexpr const char* kGlPlatformSymbol = "sandwallGlPlatform1";

}  // namespace render_node
