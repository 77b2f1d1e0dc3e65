// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render_node/gl/gl_platform.hpp"

struct GLFWwindow;
struct GLFWmonitor;

namespace render_node {

/// GLFW for as long as this lives; one at a time. Throws base::InputError when it does not start.
class GlfwLibrary {
public:
    GlfwLibrary();
    ~GlfwLibrary();
    GlfwLibrary(const GlfwLibrary&) = delete;
    GlfwLibrary& operator=(const GlfwLibrary&) = delete;
    /// What GLFW complained of last.
    [[nodiscard]] std::string complaint() const;
};

/// One output's window with its OpenGL context: without decorations and cursor, not to be resized.
class GlfwWindow {
public:
    /// Hidden: for its context alone.
    GlfwWindow(const GlfwLibrary& library, const std::string& display);
    /// Full screen on the output's monitor, else a window. The context shares its objects with that of `share`. Throws
    /// base::InputError with the output's name: a monitor that is not there or has no such mode, no OpenGL 3.3.
    GlfwWindow(const GlfwLibrary& library, const std::string& display, const WindowRequest& wanted,
               const PlatformRequest& request, GLFWwindow* share);

    [[nodiscard]] GLFWwindow* handle() const { return window_.get(); }
    [[nodiscard]] const std::string& name() const { return wanted_.output.name; }
    [[nodiscard]] bool quadBuffers() const { return quadBuffers_; }
    /// Pressed characters go to the end of `keys`; Escape and q are character 27.
    void sendKeysTo(const std::shared_ptr<std::string>& keys);
    /// What of the window is not as asked for: place, size, refresh rate. Asks the X server.
    void addShortcomings(std::vector<std::string>& lines) const;

private:
    struct Destroy {
        void operator()(GLFWwindow* window) const;
    };
    void open(const GlfwLibrary& library, const std::string& display, GLFWmonitor* monitor, GLFWwindow* share);

    WindowRequest wanted_;
    double refreshHz_ = 0;  // 0: any will do
    bool quadBuffers_ = false;
    std::shared_ptr<std::string> keys_;
    std::unique_ptr<GLFWwindow, Destroy> window_;
};

/// Number of the screen that windows are on: 1 for display ":0.1".
[[nodiscard]] int displayScreen();

}  // namespace render_node
