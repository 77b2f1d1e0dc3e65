// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

struct _XDisplay;  // NOLINT(bugprone-reserved-identifier): Xlib's own name of its Display

namespace support {

/// The monitors of an X screen, as xrandr changes them. Holds a connection to the server: destroy it before the server
/// ends. All functions throw std::runtime_error if the server refuses.
class XMonitors {
public:
    explicit XMonitors(const std::string& display);

    /// Sets the size of the X screen [pixel]. All monitors must lie within it.
    void setScreen(glm::ivec2 size) const;
    /// Gives a monitor a mode of this size [pixel], and does not switch to it.
    void addMode(const std::string& monitor, glm::ivec2 size) const;
    /// Takes the modes of this size away from a monitor that does not show one.
    void removeMode(const std::string& monitor, glm::ivec2 size) const;

    struct Place {
        std::string monitor;
        glm::ivec2 low{0}, size{0};  // [pixel]
    };
    /// Switches monitors on, at these places of the screen and in modes of these sizes. All change at once: no other
    /// client sees one of them changed alone.
    void show(const std::vector<Place>& places) const;
    /// Switches a monitor off, as when its cable is pulled out.
    void switchOff(const std::string& monitor) const;

    /// Returns the place of a window on the screen and its size [pixel]. Size 0 if the window is hidden.
    [[nodiscard]] Place placeOf(unsigned long window) const;

private:
    struct Close {
        void operator()(_XDisplay* display) const;
    };
    std::unique_ptr<_XDisplay, Close> display_;
    unsigned long root_;
};

}  // namespace support
