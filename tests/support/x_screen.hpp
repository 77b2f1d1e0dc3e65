// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pictures/image.hpp"

struct _XDisplay;  // NOLINT(bugprone-reserved-identifier): Xlib's own name of its Display

namespace support {

/// What stands on an X screen, and what a user or a window manager does to it. A connection as long as this lives: it
/// must go before the server does, or Xlib ends the test.
class XScreen {
public:
    explicit XScreen(const std::string& display);

    /// A part of the screen as it is now.
    [[nodiscard]] pictures::Image picture(int x, int y, int width, int height) const;
    /// Whether that part becomes equal to the picture within a minute.
    [[nodiscard]] bool comesToShow(const pictures::Image& expected, int x, int y) const;

    /// Gives the only monitor another mode, of the screen's size. It does not become the current one.
    void addMode(double hertz) const;
    /// Returns the refresh rate of the monitor's current mode [Hz]; 0 for one without a pixel clock.
    [[nodiscard]] double refreshRate() const;

    /// The windows that can be seen, the lowest first.
    [[nodiscard]] std::vector<unsigned long> windows() const;
    void destroy(unsigned long window) const;
    /// What a window manager sends when its close button is pressed.
    void askToClose(unsigned long window) const;
    /// A key press and release: 't', or 27 for Escape.
    void type(unsigned long window, char key) const;
    /// Moves the pointer to a place of the window.
    void point(unsigned long window, int x, int y) const;
    /// Presses or lets go of a button: 1 is the left one, 4 and 5 are the wheel's notches away and near.
    void button(unsigned long window, unsigned int number, bool down) const;

private:
    struct Close {
        void operator()(_XDisplay* display) const;
    };
    std::unique_ptr<_XDisplay, Close> display_;
    unsigned long root_;
};

}  // namespace support
