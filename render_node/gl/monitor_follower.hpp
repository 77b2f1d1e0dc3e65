// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/monitor_state.hpp"
#include "render_node/gl/gl_platform.hpp"
#include "render_node/gl/monitor_watch.hpp"

struct GLFWwindow;
struct GLFWmonitor;

namespace render_node {

/// Keeps each full screen window on the monitor that its output names, while monitors are switched off and on, move, or
/// change their mode.
///
/// A window whose monitor has no picture is hidden, because it would lie over other monitors. It comes back with the
/// picture. If the monitor has another size then, it is set to the output's size, as at the start. All windows must
/// outlive the follower. Used by one thread.
class MonitorFollower {
public:
    /// Follows the monitors of `display`. Throws base::InputError if the display cannot be opened.
    explicit MonitorFollower(const std::string& display) : watch_(display) {}

    /// Adds the window of an output that names a monitor. `index` is its number in state().
    /// @param refreshRate  Refresh rate of the full screen [Hz], or GLFW_DONT_CARE.
    void add(GLFWwindow* window, const WindowRequest& wanted, int refreshRate, std::size_t index);

    /// Puts the windows where their monitors are, if a monitor has changed. Without a change it asks the server
    /// nothing. Called after GLFW has processed its events.
    void follow();
    /// Returns the state of an output's monitor. An output without a monitor is always on.
    [[nodiscard]] base::MonitorState state(std::size_t index) const;

private:
    struct Window {
        GLFWwindow* handle;
        std::string monitor;
        glm::ivec2 pixels;  // [pixel]
        int refreshRate;    // [Hz]
        std::size_t index;
        base::MonitorState state = base::MonitorState::on;
    };
    [[nodiscard]] bool isDue();
    [[nodiscard]] base::MonitorState follow(const Window& window) const;

    MonitorWatch watch_;
    std::vector<Window> windows_;
    std::int64_t lookAgainNs_ = 0;  // [ns], time of the next look after a change; 0: none
    std::int64_t lookUntilNs_ = 0;  // [ns], end of the looks after a change
};

}  // namespace render_node
