// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/keystroke.hpp"
#include "base/monitor_state.hpp"
#include "render_node/gl/pixel_rect.hpp"
#include "render_node/gl/screen_cover.hpp"
#include "walls/wall.hpp"

namespace render_node {

using GlFunction = void (*)();

/// Window to open: an output, and the size of its picture [pixel].
struct WindowRequest {
    walls::Output output;
    glm::ivec2 pixels{1, 1};
    bool follows = false;  // the window may change its size, and the picture follows it (walls::followsWindow)
    std::string title = "Sandwall";
};

/// Event of the pointer in a window. The pointer is a mouse, a pen, or a finger on a touch screen, as the window system
/// reports it.
struct PointerEvent {
    enum class Kind : std::uint8_t {
        move,         // to `at`
        press,        // the left button goes down, or a finger touches
        release,      // the left button goes up
        turnPress,    // the right button goes down
        panPress,     // the middle button goes down, or the right one with Shift
        viewRelease,  // the right or the middle button goes up
        wheel         // the wheel has turned by `notches`
    };
    Kind kind = Kind::move;
    std::size_t window = 0;  // index in PlatformRequest::windows
    glm::dvec2 at{0};        // [pixel] from the window's top left corner; outside of it while a button is held
    std::int64_t ns = 0;     // [ns], monotonic clock
    double notches = 0;      // of the wheel, positive towards the user
    bool shift = false;      // a Shift key is down
    bool control = false;    // a Ctrl key is down
};

/// Request for a backend. Without windows the backend draws off screen.
struct PlatformRequest {
    std::string processName = "this process";  // such as "rank 3 (r1c3)"; begins the last line that a process prints
                                               // when its X server is lost
    std::string display;                       // X display; empty: $DISPLAY
    int device = -1;                           // number of the EGL device; -1: the driver chooses
    bool software = false;                     // the driver chooses EGL's software device
    bool eyesInTurn = false;                   // active stereo; without quad buffers, one eye per frame in turn
    double refreshHz = 60;
    bool onDesk = false;   // a user who closes a window ends the session
    bool pointer = false;  // the pointer is shown, and takePointer() returns its events
    std::vector<WindowRequest> windows;
};

/// Interface of a backend's module: contexts and windows.
///
/// A module does no drawing, so that OpenGL's functions are loaded once, by the program. The class has only constants
/// and pure virtual functions, so that a module needs no symbol of the program. Used by one thread.
class GlPlatform {
public:
    GlPlatform() = default;
    GlPlatform(const GlPlatform&) = delete;
    GlPlatform& operator=(const GlPlatform&) = delete;
    virtual ~GlPlatform() = default;

    /// Makes context number `context` current. Context 0 draws the pictures and shows window 0. Each other context
    /// shares its objects and shows one window. Throws base::InputError if the driver refuses.
    virtual void makeCurrent(std::size_t context) = 0;
    [[nodiscard]] virtual GlFunction functionNamed(const char* name) = 0;

    /// Returns the part of the first monitor that the desktop leaves to windows; nullopt without a display.
    [[nodiscard]] virtual std::optional<ScreenRect> workArea() const { return std::nullopt; }

    // The functions below are for windows. `window` is an index in PlatformRequest::windows. Without windows, each
    // function does what its body here does.

    [[nodiscard]] virtual bool quadBuffers(std::size_t /* window */) const { return false; }
    /// Returns the present size of a window that the picture follows [pixel], or 0 × 0 of another window.
    [[nodiscard]] virtual glm::ivec2 followedSize(std::size_t /* window */) const { return {}; }
    /// Says that a window has another size since the last swap(). For some frames keepsPicture() is then false.
    virtual void resized(std::size_t /* window */) {}
    /// Processes the events of the window system, and puts each window of a named monitor where that monitor is. Throws
    /// std::runtime_error, which names the output, if a window is lost.
    virtual void check() {}
    /// Returns the states of the monitors that the windows' outputs name, as of the last check().
    [[nodiscard]] virtual std::vector<base::MonitorState> monitorStates() const { return {}; }
    /// Returns whether the back buffer of a window keeps its picture when the window is swapped. Then only pixels that
    /// change must be drawn into it.
    [[nodiscard]] virtual bool keepsPicture(std::size_t /* window */) const { return false; }
    /// Returns whether a window has lost pixels since the last call, because it was hidden or has grown.
    [[nodiscard]] virtual bool takeExposed(std::size_t /* window */) { return false; }
    /// Swaps all windows. `frame` is the number of the wall's frame, for eyes in turn. `changed` has the pixels of each
    /// window's back buffer that have changed since the last swap.
    virtual void swap(std::uint64_t /* frame */, std::span<const PixelRect> /* changed */) {}
    /// Returns the keys that were pressed in the windows since the last call. Closing a window is base::kCloseKey.
    [[nodiscard]] virtual std::vector<base::Keystroke> takeKeys() { return {}; }
    /// Returns the events of the pointer in the windows since the last call, in the order of time. Returns an empty
    /// list if the request was without the pointer.
    [[nodiscard]] virtual std::vector<PointerEvent> takePointer() { return {}; }
    /// Waits until the window system has an event, and at most `seconds` [s]. Processes the events.
    virtual void awaitEvents(double /* seconds */) {}
    /// Returns one line for the operator for each request of the wall file that this machine cannot meet.
    [[nodiscard]] virtual std::vector<std::string> shortcomings() const { return {}; }
    /// Returns how hardware locks the swaps of the windows:
    /// - "joined": all cards with a sync signal swap together.
    /// - "joined, no barrier": the windows of one card swap together.
    /// - "refused" or "no extension": nothing is locked, because the driver refuses it or cannot do it.
    /// - "none": there are no windows.
    [[nodiscard]] virtual std::string swapLock() const { return "none"; }
    /// Returns the number of frames after the start in which a hardware barrier settles. The skew leaves them out.
    [[nodiscard]] virtual int framesToIgnore() const { return 0; }
};

/// The only symbol of a module. Its number changes with this header. Throws base::InputError.
extern "C" GlPlatform* sandwallGlPlatform8(const PlatformRequest& request);
inline constexpr const char* kGlPlatformSymbol = "sandwallGlPlatform8";

}  // namespace render_node
