// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "render_node/gl/screen_cover.hpp"

struct _XDisplay;  // NOLINT(bugprone-reserved-identifier): Xlib's own name of its Display

namespace render_node {

/// A monitor as the X server knows it.
struct Monitor {
    bool connected = false;  // a cable is plugged in, and the monitor answers
    ScreenRect area;         // of its picture on the X screen; empty if it has no picture
};

/// Connection to the X server that reports when monitors come, go, move or change their mode.
///
/// GLFW reports only monitors that come or go, and keeps what it knew of the others. Not thread-safe.
class MonitorWatch {
public:
    /// Connects to `display`, written as in a wall file. Without RandR 1.2 no monitor ever changes. Throws
    /// base::InputError if the display cannot be opened.
    explicit MonitorWatch(const std::string& display);

    /// Returns whether a monitor of the screen has changed since the last call. Does not ask the server.
    [[nodiscard]] bool takeChanged();
    /// Returns the monitor that xrandr lists under this name; nullopt if there is none. Asks the server.
    [[nodiscard]] std::optional<Monitor> named(const std::string& name) const;

private:
    struct Close {
        void operator()(_XDisplay* display) const;
    };
    std::unique_ptr<_XDisplay, Close> display_;
    bool available_ = false;
    int firstEvent_ = 0;  // number of RandR's first kind of event
};

}  // namespace render_node
