// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pictures/image.hpp"

struct _XDisplay;  // NOLINT(bugprone-reserved-identifier): Xlib's own name of its Display

namespace support {

/// Access to the windows of an X screen, and the actions of a user or a window manager. Holds a connection to the
/// server. Destroy it before the server ends, because otherwise Xlib ends the test.
class XScreen {
public:
    explicit XScreen(const std::string& display);

    /// Returns a part of the screen as it is now.
    [[nodiscard]] pictures::Image picture(int x, int y, int width, int height) const;
    /// Returns true if the part of the screen at (x, y) becomes equal to the picture within a minute.
    [[nodiscard]] bool comesToShow(const pictures::Image& expected, int x, int y) const;

    /// Adds a mode of the screen's size to the only monitor. Does not switch to this mode.
    void addMode(double hertz) const;
    /// Returns the refresh rate of the monitor's current mode [Hz], or 0 for a mode without a pixel clock.
    [[nodiscard]] double refreshRate() const;

    /// Switches the only monitor off, as when its cable is pulled out.
    void switchMonitorOff() const;
    /// Sets the scale that the desktop asks programs for. A program reads it when it connects.
    void setScale(double scale) const;

    /// Returns the visible windows, the lowest one first.
    [[nodiscard]] std::vector<unsigned long> windows() const;
    [[nodiscard]] std::string title(unsigned long window) const;
    [[nodiscard]] std::string classOf(unsigned long window) const;
    [[nodiscard]] bool hasIcon(unsigned long window) const;
    void resize(unsigned long window, int width, int height) const;
    void destroy(unsigned long window) const;
    /// Hides the window and shows it again. The server forgets its pixels.
    void hideForAMoment(unsigned long window) const;
    /// Sends the message that a window manager sends when the user presses the close button.
    void askToClose(unsigned long window) const;
    // Symbols of keys, as X has them. A small letter is its own symbol.
    static constexpr unsigned long kEscape = 0xff1b, kHome = 0xff50, kPageUp = 0xff55, kF1 = 0xffbe;
    static constexpr unsigned long kF9 = 0xffc6, kF11 = 0xffc8, kF12 = 0xffc9;
    static constexpr unsigned kShift = 1, kControl = 4;  // states of modifiers
    /// Sends a key press and its release. `symbol` is the key's symbol without modifiers, such as 't' or kF1, and
    /// `state` the sum of the modifiers that are held.
    void type(unsigned long window, unsigned long symbol, unsigned int state = 0) const;
    /// Moves the pointer to a place in the window.
    void point(unsigned long window, int x, int y) const;
    /// Presses or releases a button. 1 is the left button. 4 and 5 are the wheel's notches away from the user and
    /// towards the user.
    void button(unsigned long window, unsigned int number, bool down) const;
    /// Presses or releases a button of the pointer itself. Returns false without libXtst.
    [[nodiscard]] bool pressForReal(unsigned int number, bool down) const;
    /// Gives the focus to a window of the test's own.
    void focusAnotherWindow() const;
    void hide(unsigned long window) const;

private:
    struct Close {
        void operator()(_XDisplay* display) const;
    };
    std::unique_ptr<_XDisplay, Close> display_;
    unsigned long root_;
};

}  // namespace support
