// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <string>
#include <vector>

struct _XDisplay;  // NOLINT(bugprone-reserved-identifier): Xlib's own name of its Display

namespace render_node {

/// A connection to the X server beside GLFW's, which keeps to itself what it hears of windows that are gone.
///
/// Xlib has one error handler per process: one at a time may live. Not thread-safe.
class XWatch {
public:
    /// `display` as in a wall file; empty: $DISPLAY, which is set to it otherwise. Throws base::InputError when there
    /// is none or it cannot be opened. From here on, a lost X server ends the process with status 1 and one line that
    /// begins with `who` and the host: Xlib cannot go on, and whoever waits for this rank must not wait.
    XWatch(const std::string& display, const std::string& who);
    ~XWatch();
    XWatch(const XWatch&) = delete;
    XWatch& operator=(const XWatch&) = delete;

    /// Once GLFW has made its windows (it puts back Xlib's deadly handler whenever it makes one).
    void watch(const std::vector<unsigned long>& windows);
    /// The first window that is gone, by its place in the list, else -1. Throws std::runtime_error when the server has
    /// refused a request for any other reason.
    [[nodiscard]] int firstLost();
    [[nodiscard]] const std::string& name() const { return name_; }  // ":1"

private:
    void takeEvents();

    std::string name_;
    _XDisplay* display_;
    std::vector<unsigned long> windows_;
    int lost_ = -1;
};

}  // namespace render_node
