// SPDX-License-Identifier: Apache-2.0
#include "tests/support/screens/x_screen.hpp"

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/Xrandr.h>
#include <dlfcn.h>

#include <chrono>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>

namespace support {
namespace {

using Resources = std::unique_ptr<XRRScreenResources, void (*)(XRRScreenResources*)>;

/// Returns the outputs, modes and monitor controllers (CRTCs) of one screen.
Resources resourcesOf(_XDisplay* display, unsigned long root) {
    Resources resources(XRRGetScreenResources(display, root), XRRFreeScreenResources);
    if (resources == nullptr || resources->noutput != 1 || resources->ncrtc != 1) {
        throw std::runtime_error("the X server must have exactly one monitor");
    }
    return resources;
}

}  // namespace

void XScreen::Close::operator()(_XDisplay* display) const { XCloseDisplay(display); }

XScreen::XScreen(const std::string& display) : display_(XOpenDisplay(display.c_str())) {
    if (display_ == nullptr) {
        throw std::runtime_error("the test cannot open display " + display);
    }
    root_ = DefaultRootWindow(display_.get());
}

pictures::Image XScreen::picture(int x, int y, int width, int height) const {
    XImage* image = XGetImage(display_.get(), root_, x, y, static_cast<unsigned>(width), static_cast<unsigned>(height),
                              AllPlanes, ZPixmap);
    if (image == nullptr) {
        throw std::runtime_error("the X server returned no picture of its screen");
    }
    pictures::Image result(width, height);
    std::size_t next = 0;
    for (int row = 0; row < height; ++row) {
        for (int column = 0; column < width; ++column) {
            const unsigned long pixel = XGetPixel(image, column, row);  // 24 bits: 0xRRGGBB
            for (const int shift : {16, 8, 0}) {
                result.rgb[next++] = static_cast<std::uint8_t>(pixel >> shift & 0xFFU);
            }
        }
    }
    XDestroyImage(image);
    return result;
}

bool XScreen::comesToShow(const pictures::Image& expected, int x, int y) const {
    // The server may draw a picture some time after it was sent.
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (picture(x, y, expected.width, expected.height).rgb != expected.rgb) {
        if (std::chrono::steady_clock::now() > until) {
            return false;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
}

void XScreen::addMode(double hertz) const {
    const Resources resources = resourcesOf(display_.get(), root_);
    std::string name = "test-" + std::to_string(std::lround(hertz));
    XRRModeInfo mode{};
    mode.width = static_cast<unsigned>(DisplayWidth(display_.get(), DefaultScreen(display_.get())));
    mode.height = static_cast<unsigned>(DisplayHeight(display_.get(), DefaultScreen(display_.get())));
    // Adds a tenth to the width and a twentieth to the height for the beam's way back, as an analogue monitor would
    // need.
    mode.hTotal = mode.width + mode.width / 10;
    mode.hSyncStart = mode.width + 1;
    mode.hSyncEnd = mode.hTotal - 1;
    mode.vTotal = mode.height + mode.height / 20;
    mode.vSyncStart = mode.height + 1;
    mode.vSyncEnd = mode.vTotal - 1;
    mode.dotClock = static_cast<unsigned long>(std::lround(hertz * mode.hTotal * mode.vTotal));
    mode.name = name.data();
    mode.nameLength = static_cast<unsigned>(name.size());
    const RRMode created = XRRCreateMode(display_.get(), root_, &mode);
    XRRAddOutputMode(display_.get(), resources->outputs[0], created);
    XSync(display_.get(), False);
}

double XScreen::refreshRate() const {
    const Resources resources = resourcesOf(display_.get(), root_);
    const std::unique_ptr<XRRCrtcInfo, void (*)(XRRCrtcInfo*)> monitor(
        XRRGetCrtcInfo(display_.get(), resources.get(), resources->crtcs[0]), XRRFreeCrtcInfo);
    for (const XRRModeInfo& mode : std::span(resources->modes, static_cast<std::size_t>(resources->nmode))) {
        if (monitor != nullptr && mode.id == monitor->mode && mode.hTotal != 0 && mode.vTotal != 0) {
            return static_cast<double>(mode.dotClock) / mode.hTotal / mode.vTotal;
        }
    }
    return 0;
}

void XScreen::switchMonitorOff() const {
    const Resources resources = resourcesOf(display_.get(), root_);
    if (XRRSetCrtcConfig(display_.get(), resources.get(), resources->crtcs[0], CurrentTime, 0, 0, None, RR_Rotate_0,
                         nullptr, 0) != RRSetConfigSuccess) {
        throw std::runtime_error("the X server keeps its monitor on");
    }
}

void XScreen::setScale(double scale) const {
    const std::string resources = "Xft.dpi:\t" + std::to_string(std::lround(96 * scale)) + "\n";
    XChangeProperty(display_.get(), root_, XA_RESOURCE_MANAGER, XA_STRING, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(resources.data()), static_cast<int>(resources.size()));
    XSync(display_.get(), False);
}

std::vector<unsigned long> XScreen::windows() const {
    Window root = 0;
    Window parent = 0;
    Window* children = nullptr;
    unsigned count = 0;
    XQueryTree(display_.get(), root_, &root, &parent, &children, &count);
    std::vector<unsigned long> seen;
    for (unsigned i = 0; i < count; ++i) {
        XWindowAttributes attributes{};
        if (XGetWindowAttributes(display_.get(), children[i], &attributes) != 0 && attributes.map_state == IsViewable) {
            seen.push_back(children[i]);
        }
    }
    XFree(children);
    return seen;
}

std::string XScreen::title(unsigned long window) const {
    Atom type = None;
    int format = 0;
    unsigned long bytes = 0, left = 0;
    unsigned char* text = nullptr;
    XGetWindowProperty(display_.get(), window, XInternAtom(display_.get(), "_NET_WM_NAME", False), 0, 256, False,
                       XInternAtom(display_.get(), "UTF8_STRING", False), &type, &format, &bytes, &left, &text);
    std::string title(reinterpret_cast<const char*>(text), text == nullptr ? 0 : bytes);
    XFree(text);
    return title;
}

std::string XScreen::classOf(unsigned long window) const {
    XClassHint hint{};
    if (XGetClassHint(display_.get(), window, &hint) == 0) {
        return {};
    }
    std::string name = hint.res_class;
    XFree(hint.res_name);
    XFree(hint.res_class);
    return name;
}

bool XScreen::hasIcon(unsigned long window) const {
    Atom type = None;
    int format = 0;
    unsigned long count = 0, left = 0;
    unsigned char* data = nullptr;
    XGetWindowProperty(display_.get(), window, XInternAtom(display_.get(), "_NET_WM_ICON", False), 0, 2, False,
                       XA_CARDINAL, &type, &format, &count, &left, &data);
    XFree(data);
    return type == XA_CARDINAL && count == 2 && left > 0;  // width, height, and the pixels
}

void XScreen::resize(unsigned long window, int width, int height) const {
    XResizeWindow(display_.get(), window, static_cast<unsigned>(width), static_cast<unsigned>(height));
    XSync(display_.get(), False);
}

void XScreen::destroy(unsigned long window) const {
    XDestroyWindow(display_.get(), window);
    XSync(display_.get(), False);
}

void XScreen::hideForAMoment(unsigned long window) const {
    XUnmapWindow(display_.get(), window);
    XMapWindow(display_.get(), window);
    XSync(display_.get(), 0);
}

void XScreen::askToClose(unsigned long window) const {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = window;
    event.xclient.message_type = XInternAtom(display_.get(), "WM_PROTOCOLS", False);
    event.xclient.format = 32;
    event.xclient.data.l[0] = static_cast<long>(XInternAtom(display_.get(), "WM_DELETE_WINDOW", False));
    XSendEvent(display_.get(), window, False, NoEventMask, &event);
    XSync(display_.get(), False);
}

void XScreen::type(unsigned long window, unsigned long symbol, unsigned int state) const {
    static Time time = 0;
    XEvent event{};
    event.xkey.display = display_.get();
    event.xkey.window = window;
    event.xkey.root = root_;
    event.xkey.same_screen = True;
    event.xkey.state = state;
    event.xkey.keycode = XKeysymToKeycode(display_.get(), symbol);
    for (const int kind : {KeyPress, KeyRelease}) {
        event.xkey.type = kind;
        event.xkey.time = time += 10;  // GLFW drops a press at the time of an earlier one
        XSendEvent(display_.get(), window, False, kind == KeyPress ? KeyPressMask : KeyReleaseMask, &event);
    }
    XSync(display_.get(), False);
}

void XScreen::point(unsigned long window, int x, int y) const {
    XWarpPointer(display_.get(), None, window, 0, 0, 0, 0, x, y);
    XSync(display_.get(), False);
}

void XScreen::button(unsigned long window, unsigned int number, bool down) const {
    XEvent event{};
    event.xbutton.type = down ? ButtonPress : ButtonRelease;
    event.xbutton.display = display_.get();
    event.xbutton.window = window;
    event.xbutton.root = root_;
    event.xbutton.same_screen = True;
    event.xbutton.button = number;
    XSendEvent(display_.get(), window, False, down ? ButtonPressMask : ButtonReleaseMask, &event);
    XSync(display_.get(), False);
}

bool XScreen::pressForReal(unsigned int number, bool down) const {
    using Fake = int(_XDisplay*, unsigned int, int, unsigned long);
    static void* const library = dlopen("libXtst.so.6", RTLD_NOW);
    const auto fake = library == nullptr ? nullptr : reinterpret_cast<Fake*>(dlsym(library, "XTestFakeButtonEvent"));
    if (fake == nullptr) {
        return false;
    }
    fake(display_.get(), number, down ? True : False, CurrentTime);
    XSync(display_.get(), False);
    return true;
}

void XScreen::focusAnotherWindow() const {
    const Window other = XCreateSimpleWindow(display_.get(), root_, 0, 0, 1, 1, 0, 0, 0);
    XMapWindow(display_.get(), other);
    XSync(display_.get(), False);
    XSetInputFocus(display_.get(), other, RevertToNone, CurrentTime);
    XSync(display_.get(), False);
}

void XScreen::hide(unsigned long window) const {
    XUnmapWindow(display_.get(), window);
    XSync(display_.get(), False);
}

}  // namespace support
