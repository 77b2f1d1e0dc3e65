// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <string>
#include <vector>

#include "render_node/gl/button_watch.hpp"

struct _XDisplay;  // NOLINT(bugprone-reserved-identifier): Xlib's own name of its Display

namespace render_node {

/// Second connection to the X server, beside GLFW's. It watches the windows and reports a lost window to its owner
/// only.
///
/// Only one object may live at a time, because Xlib has one error handler per process. Not thread-safe.
class XWatch {
public:
    /// Connects to `display`, written as in a wall file, and sets $DISPLAY to it. If `display` is empty, connects to
    /// $DISPLAY. Throws base::InputError if there is no display or if it cannot be opened. With
    /// `needsWindows`, the error does not advise to draw off screen.
    ///
    /// From then on, a lost X server ends the process with status 1 and one line that begins with `processName` and the
    /// host. The process must end because Xlib cannot continue and other ranks wait for this rank.
    XWatch(const std::string& display, const std::string& processName, bool needsWindows);
    ~XWatch();
    XWatch(const XWatch&) = delete;
    XWatch& operator=(const XWatch&) = delete;

    /// Starts watching `windows`. Must be called after GLFW has made its windows, because GLFW restores Xlib's error
    /// handler, which ends the process, each time it makes one.
    void watch(const std::vector<unsigned long>& windows);
    /// Returns the index of the first lost window, or -1. Throws std::runtime_error if the server refused a request for
    /// another reason.
    [[nodiscard]] int firstLost();
    /// Returns the buttons of the pointer that are down now. Asks the X server.
    [[nodiscard]] ButtonWatch::Down buttons() const;
    [[nodiscard]] const std::string& name() const { return name_; }  // ":1"

private:
    void takeEvents();

    std::string name_;
    _XDisplay* display_;
    std::vector<unsigned long> windows_;
    int lost_ = -1;
};

}  // namespace render_node
