// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/x_watch.hpp"

#include <X11/Xlib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <stdexcept>

#include "base/not_yet_error.hpp"

namespace render_node {
namespace {

// These variables are global, because Xlib passes no user data to its handlers.
std::string lastWords;
std::string refusal;
int monitorRequests = 0;  // number of RandR's requests; 0: the server has none

int endWithoutServer(Display* /* display */) {
    (void)!write(STDERR_FILENO, lastWords.data(), lastWords.size());
    // Does not call exit(), because the cleanup would talk to the server or wait for other ranks.
    _exit(1);
}

/// GLFW sets a mode back on a monitor that has gone meanwhile. Such a refusal harms no window.
int noteRefusal(Display* display, XErrorEvent* error) {
    if (refusal.empty() && error->request_code != monitorRequests) {
        std::array<char, 128> text{};
        XGetErrorText(display, error->error_code, text.data(), static_cast<int>(text.size()));
        refusal = std::string(text.data()) + ", request " + std::to_string(error->request_code) + "." +
                  std::to_string(error->minor_code);
    }
    return 0;
}

/// `other` says what to choose where there is no display.
std::string chosenDisplay(const std::string& display, const char* other) {
    if (!display.empty()) {
        setenv("DISPLAY", display.c_str(), 1);
        return display;
    }
    const char* fromEnvironment = std::getenv("DISPLAY");
    if (fromEnvironment == nullptr || *fromEnvironment == '\0') {
        if (const char* wayland = std::getenv("WAYLAND_DISPLAY"); wayland != nullptr && *wayland != '\0') {
            throw base::InputError(
                "--gl glfw: no X display (DISPLAY is not set); on this Wayland desktop windows need Xwayland: install "
                "Xwayland (Debian's xwayland), and log in again");
        }
        throw base::InputError(
            std::string("--gl glfw: no X display; set DISPLAY, give the tile's place in the wall file one (display = "
                        "\":0\"), or ") +
            other);
    }
    return fromEnvironment;
}

}  // namespace

XWatch::XWatch(const std::string& display, const std::string& processName, bool needsWindows)
    : name_(chosenDisplay(display, needsWindows ? "choose another --device" : "draw off screen with --gl osmesa")),
      display_(XOpenDisplay(name_.c_str())) {
    if (display_ == nullptr) {
        throw base::NotYetError("--gl glfw: cannot open X display " + name_ +
                                "; is its server running, and may this user use it (docs/backends.md)?");
    }
    int firstEvent = 0, firstError = 0;
    (void)XQueryExtension(display_, "RANDR", &monitorRequests, &firstEvent, &firstError);
    std::array<char, 256> host{};
    (void)gethostname(host.data(), host.size() - 1);
    lastWords = processName + " on " + host.data() + ": the X server of " + name_ + " is gone\n";
    XSetIOErrorHandler(endWithoutServer);
}

XWatch::~XWatch() {
    XSetErrorHandler(nullptr);
    XCloseDisplay(display_);
    XSetIOErrorHandler(nullptr);
}

void XWatch::watch(const std::vector<unsigned long>& windows) {
    windows_ = windows;
    refusal.clear();
    XSetErrorHandler(noteRefusal);
    for (const unsigned long window : windows_) {
        XSelectInput(display_, window, StructureNotifyMask);
    }
    XSync(display_, False);
}

void XWatch::takeEvents() {
    while (XPending(display_) > 0) {
        XEvent event;
        XNextEvent(display_, &event);
        if (event.type == DestroyNotify && lost_ < 0) {
            const auto found = std::find(windows_.begin(), windows_.end(), event.xdestroywindow.window);
            lost_ = found == windows_.end() ? -1 : static_cast<int>(found - windows_.begin());
        }
    }
}

ButtonWatch::Down XWatch::buttons() const {
    Window root = None, child = None;
    int rootX = 0, rootY = 0, x = 0, y = 0;
    unsigned int mask = 0;
    XQueryPointer(display_, DefaultRootWindow(display_), &root, &child, &rootX, &rootY, &x, &y, &mask);
    return {.left = (mask & Button1Mask) != 0, .view = (mask & (Button2Mask | Button3Mask)) != 0};
}

int XWatch::firstLost() {
    takeEvents();
    if (lost_ < 0 && !refusal.empty()) {
        // The refusal came over GLFW's connection. The event of a lost window may still be on its way over this
        // connection.
        XSync(display_, False);
        takeEvents();
        if (lost_ < 0) {
            throw std::runtime_error("the X server of " + name_ + " refused: " + refusal);
        }
    }
    return lost_;
}

}  // namespace render_node
