// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render_node/gl/gl_platform.hpp"
#include "render_node/gl/key_event.hpp"
#include "walls/window_size.hpp"

struct GLFWwindow;
struct GLFWmonitor;
struct GLFWcursor;

namespace render_node {

/// Runs GLFW during its lifetime. Only one object may live at a time. Throws base::InputError if GLFW does not start.
class GlfwLibrary {
public:
    GlfwLibrary();
    ~GlfwLibrary();
    GlfwLibrary(const GlfwLibrary&) = delete;
    GlfwLibrary& operator=(const GlfwLibrary&) = delete;
    /// Returns GLFW's last error message.
    [[nodiscard]] std::string complaint() const;
};

/// Input of all windows since it was taken last.
struct WindowInput {
    std::vector<base::Keystroke> keys;
    std::vector<PointerEvent> pointer;
};

/// Window of one output, with its OpenGL context. It shows a cursor only if the request asks for the pointer.
///
/// A window that the wall file does not place belongs to a desktop: it has a frame, an icon and a title. If the picture
/// follows it, its first size is that of the wall file times the scale of the monitor, and at most 90 % of the monitor.
/// The user may then change its size, and F11 switches to full screen and back.
class GlfwWindow {
public:
    /// Makes a hidden window, for its context only.
    GlfwWindow(const GlfwLibrary& library, const std::string& display);
    /// Makes a full screen on the output's monitor if the output names one, otherwise a window. The context shares its
    /// objects with the context of `share`. Throws base::InputError, which names the output, if the monitor is missing,
    /// if the monitor lacks the mode, or if there is no OpenGL 3.3.
    GlfwWindow(const GlfwLibrary& library, const std::string& display, const WindowRequest& wanted,
               const PlatformRequest& request, GLFWwindow* share);

    [[nodiscard]] GLFWwindow* handle() const { return window_.get(); }
    [[nodiscard]] const std::string& name() const { return wanted_.output.name; }
    [[nodiscard]] const WindowRequest& wanted() const { return wanted_; }
    /// Returns the refresh rate of a full screen [Hz], or GLFW_DONT_CARE.
    [[nodiscard]] int refreshRate() const { return refreshRate_; }
    [[nodiscard]] bool quadBuffers() const { return quadBuffers_; }
    /// Returns whether the wall file gives the window a place.
    [[nodiscard]] bool isPlaced() const { return walls::isPlaced(wanted_.output); }
    /// Returns the present size of the window if the picture follows it [pixel], otherwise 0 × 0.
    [[nodiscard]] glm::ivec2 followedPixels() const { return wanted_.follows ? listener_->pixels : glm::ivec2(0); }
    /// Appends the input of this window to `input` from now on. `index` is the number of the window in its events. With
    /// `pointer`, the events of the pointer are appended, too.
    void sendInputTo(const std::shared_ptr<WindowInput>& input, std::size_t index, bool pointer);
    /// Returns whether the window has lost pixels since the last call, because it was hidden. True at first.
    [[nodiscard]] bool takeExposed();
    /// Appends a line for each property that differs from the request: place, size and refresh rate. Asks the X server.
    void addShortcomings(std::vector<std::string>& lines) const;

private:
    struct Destroy {
        void operator()(GLFWwindow* window) const;
        void operator()(GLFWcursor* cursor) const;
    };
    void open(const GlfwLibrary& library, const std::string& display, GLFWmonitor* monitor, GLFWwindow* share);

    WindowRequest wanted_;
    double refreshHz_ = 0;  // 0: any rate
    int refreshRate_ = -1;  // [Hz], of a full screen
    bool quadBuffers_ = false;
    struct Listener {
        std::shared_ptr<WindowInput> input;
        std::size_t window = 0;
        glm::dvec2 at{0};                          // [pixel], of the pointer's last motion
        bool stroke = false;                       // the left button is held, and Escape has not lifted the tool
        bool exposed = true;                       // the window has lost pixels, or has shown none yet
        KeyEvent key{};                            // the last one, which may type a character
        glm::ivec2 pixels{1};                      // size of the window
        glm::ivec2 placeBefore{0}, sizeBefore{1};  // of the window before it became a full screen

        void add(const std::optional<base::Keystroke>& press) {
            if (press) {
                input->keys.push_back(*press);
            }
        }
    };
    void followKeys();
    /// Lifts the tool of a stroke, or leaves full screen. Returns whether there was one of them.
    static bool leave(GLFWwindow* window);
    static void addPointer(GLFWwindow* window, PointerEvent::Kind kind, double notches = 0);
    static void toggleFullScreen(GLFWwindow* window);
    void followPointer();
    void followSize();

    std::unique_ptr<Listener> listener_;  // at an address that stays, because GLFW keeps it
    std::unique_ptr<GLFWwindow, Destroy> window_;
    std::unique_ptr<GLFWcursor, Destroy> cursor_;
};

/// Returns the part of the first monitor that the desktop leaves to windows. Without a monitor, returns the whole
/// screen.
[[nodiscard]] ScreenRect workArea();

/// Returns the number of the X screen that the windows are on, such as 1 for display ":0.1".
[[nodiscard]] int displayScreen();

}  // namespace render_node
