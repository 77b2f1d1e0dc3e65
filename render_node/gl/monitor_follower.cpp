// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/monitor_follower.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <optional>
#include <span>

#include "host/clock.hpp"
#include "render_node/gl/glfw_monitors.hpp"

namespace render_node {
namespace {

using base::MonitorState;

// A window manager may move a window some time after a monitor has changed, and GLFW may learn of the change later.
constexpr std::int64_t kLookEveryNs = 250'000'000;     // [ns]
constexpr std::int64_t kLookForNs = 2'000'000'000;     // [ns]
constexpr std::int64_t kLookAtDarkNs = 1'000'000'000;  // [ns], between two looks at a monitor that is dark

/// Returns GLFW's monitor of this name on which a full screen can have this size. Returns null if GLFW does not know
/// it. Also returns null if GLFW takes it for one at another place, or has not learnt of its mode. A full screen would
/// then be on another monitor, or in another mode.
GLFWmonitor* knownToGlfw(const std::string& name, const ScreenRect& area, glm::ivec2 pixels) {
    const std::span<GLFWmonitor*> all = glfwMonitors();
    const auto found = std::ranges::find_if(all, [&](GLFWmonitor* monitor) {
        const ScreenRect known = areaOf(monitor);
        return glfwGetMonitorName(monitor) == name && known.low == area.low && known.high == area.high &&
               hasMode(monitor, pixels);
    });
    return found == all.end() ? nullptr : *found;
}

bool isAt(GLFWwindow* window, const ScreenRect& area) {
    glm::ivec2 low, size;
    glfwGetWindowPos(window, &low.x, &low.y);
    glfwGetWindowSize(window, &size.x, &size.y);
    return glfwGetWindowAttrib(window, GLFW_VISIBLE) != 0 && low == area.low && size == area.high - area.low;
}

/// Makes a window of a full screen. GLFW hides and places windows only.
void leaveFullScreen(GLFWwindow* window, const ScreenRect& area) {
    const glm::ivec2 size = area.high - area.low;
    glfwSetWindowMonitor(window, nullptr, area.low.x, area.low.y, size.x, size.y, GLFW_DONT_CARE);
}

void hide(GLFWwindow* window, glm::ivec2 pixels) {
    if (glfwGetWindowMonitor(window) != nullptr) {
        leaveFullScreen(window, {{0, 0}, pixels});
    }
    if (glfwGetWindowAttrib(window, GLFW_VISIBLE) != 0) {
        glfwHideWindow(window);
    }
}

}  // namespace

void MonitorFollower::add(GLFWwindow* window, const WindowRequest& wanted, int refreshRate, std::size_t index) {
    windows_.push_back({window, wanted.output.monitor, wanted.pixels, refreshRate, index});
}

MonitorState MonitorFollower::state(std::size_t index) const {
    const auto found = std::ranges::find(windows_, index, &Window::index);
    return found == windows_.end() ? MonitorState::on : found->state;
}

/// A change is looked at at once, and then several times for the sake of window managers.
bool MonitorFollower::isDue() {
    const std::int64_t now = host::monotonicNs();
    if (watch_.takeChanged()) {
        lookUntilNs_ = now + kLookForNs;
    } else if (lookAgainNs_ == 0 || now < lookAgainNs_) {
        return false;
    }
    const bool dark = std::ranges::any_of(windows_, [](const Window& w) { return w.state != MonitorState::on; });
    lookAgainNs_ = now < lookUntilNs_ ? now + kLookEveryNs : dark ? now + kLookAtDarkNs : 0;
    return true;
}

void MonitorFollower::follow() {
    if (isDue()) {
        for (Window& window : windows_) {
            window.state = follow(window);
        }
    }
}

MonitorState MonitorFollower::follow(const Window& window) const {
    const std::optional<Monitor> monitor = watch_.named(window.monitor);
    const ScreenRect area = monitor ? monitor->area : ScreenRect{};
    const glm::ivec2 size = area.high - area.low;
    if (size == glm::ivec2(0)) {
        hide(window.handle, window.pixels);
        return MonitorState::off;
    }
    GLFWmonitor* const known = knownToGlfw(window.monitor, area, window.pixels);
    if (size != window.pixels && known == nullptr) {
        hide(window.handle, window.pixels);
        return MonitorState::otherSize;
    }
    const bool full = known == nullptr || glfwGetWindowMonitor(window.handle) == known;
    if (size != window.pixels || !isAt(window.handle, area) || !full) {
        leaveFullScreen(window.handle, {area.low, area.low + window.pixels});
        if (known != nullptr) {
            glfwSetWindowMonitor(window.handle, known, 0, 0, window.pixels.x, window.pixels.y, window.refreshRate);
        } else if (glfwGetWindowAttrib(window.handle, GLFW_VISIBLE) == 0) {
            glfwShowWindow(window.handle);
        }
    }
    return monitor->connected ? MonitorState::on : MonitorState::off;
}

}  // namespace render_node
