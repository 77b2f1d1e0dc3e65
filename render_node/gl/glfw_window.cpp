// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/glfw_window.hpp"

#define GLFW_INCLUDE_NONE
#define GLFW_EXPOSE_NATIVE_X11
#include <GLFW/glfw3.h>
#include <GLFW/glfw3native.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/input_error.hpp"
#include "base/not_yet_error.hpp"
#include "host/clock.hpp"
#include "render_node/gl/glfw_monitors.hpp"
#include "render_node/gl/screen_cover.hpp"
#include "render_node/gl/window_icon.hpp"

namespace render_node {
namespace {

using base::InputError;

std::string lastComplaint;  // global, because GLFW passes no user data to its error handler

std::string sizeText(glm::ivec2 size) { return fmt::format("{} x {}", size.x, size.y); }
std::string placeText(glm::ivec2 place) { return fmt::format("({}, {})", place.x, place.y); }

std::vector<ScreenRect> lightedAreas() {
    std::vector<ScreenRect> areas;
    for (GLFWmonitor* monitor : glfwMonitors()) {
        areas.push_back(areaOf(monitor));
    }
    if (areas.empty()) {  // no cable is plugged in, or the server has no monitors
        Screen* screen = ScreenOfDisplay(glfwGetX11Display(), displayScreen());
        areas.push_back({{0, 0}, {WidthOfScreen(screen), HeightOfScreen(screen)}});
    }
    return areas;
}

GLFWmonitor* monitorNamed(const WindowRequest& wanted, const std::string& display) {
    std::string there;
    for (GLFWmonitor* monitor : glfwMonitors()) {
        const ScreenRect area = areaOf(monitor);
        const std::string name = glfwGetMonitorName(monitor);
        if (name == wanted.output.monitor) {
            return monitor;
        }
        there += (there.empty() ? "there is " : ", ") + name + " (" + sizeText(area.high - area.low) + ")";
    }
    throw base::NotYetError("output " + wanted.output.name + ": no monitor " + wanted.output.monitor + " on display " +
                            display + "; " + (there.empty() ? "there is none" : there));
}

void requireMode(GLFWmonitor* monitor, const WindowRequest& wanted) {
    if (hasMode(monitor, wanted.pixels)) {
        return;
    }
    const ScreenRect area = areaOf(monitor);
    throw InputError("output " + wanted.output.name + ": monitor " + wanted.output.monitor + " shows " +
                     sizeText(area.high - area.low) + " pixels and has no mode of " + sizeText(wanted.pixels) +
                     "; correct the pixels in the wall file");
}

/// Returns the refresh rate for full screen: the requested rate, or the current one if none is requested.
int refreshRateOf(GLFWmonitor* monitor, const WindowRequest& wanted, double refreshHz) {
    const GLFWvidmode* now = glfwGetVideoMode(monitor);
    if (refreshHz > 0) {
        return static_cast<int>(std::lround(refreshHz));
    }
    const bool same = now != nullptr && glm::ivec2(now->width, now->height) == wanted.pixels;
    return same ? now->refreshRate : GLFW_DONT_CARE;
}

void hintContext(bool visible) {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_API);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    // The pictures come from our own frame buffers, so that the window needs colours only.
    for (const int unused : {GLFW_ALPHA_BITS, GLFW_DEPTH_BITS, GLFW_STENCIL_BITS}) {
        glfwWindowHint(unused, 0);
    }
    for (const int off : {GLFW_DECORATED, GLFW_RESIZABLE, GLFW_AUTO_ICONIFY, GLFW_CENTER_CURSOR}) {
        glfwWindowHint(off, GLFW_FALSE);
    }
    glfwWindowHint(GLFW_VISIBLE, visible ? GLFW_TRUE : GLFW_FALSE);
    // The class of the windows, by which a desktop groups and finds them.
    glfwWindowHintString(GLFW_X11_CLASS_NAME, "sandwall");
    glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "sandwall");
}

/// Returns the first size of a window that the picture follows: `wanted` times the monitor's scale, and at most 80 % of
/// the first monitor's area for windows.
glm::ivec2 firstSize(glm::ivec2 wanted) {
    constexpr double kMost = 0.8;
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    const ScreenRect area = workArea();
    glm::vec2 scale(1);
    if (monitor != nullptr) {
        glfwGetMonitorContentScale(monitor, &scale.x, &scale.y);
    }
    const glm::dvec2 scaled = glm::dvec2(wanted) * glm::dvec2(scale);
    const glm::dvec2 most = kMost * glm::dvec2(area.high - area.low);
    return glm::max(glm::ivec2(scaled * std::min({1.0, most.x / scaled.x, most.y / scaled.y})), 1);
}

/// Returns the monitor that shows the middle of the window, or else the first one; null if there is none.
GLFWmonitor* monitorOf(GLFWwindow* window) {
    glm::ivec2 low, size;
    glfwGetWindowPos(window, &low.x, &low.y);
    glfwGetWindowSize(window, &size.x, &size.y);
    const glm::ivec2 middle = low + size / 2;
    for (GLFWmonitor* monitor : glfwMonitors()) {
        const ScreenRect area = areaOf(monitor);
        if (glm::all(glm::greaterThanEqual(middle, area.low)) && glm::all(glm::lessThan(middle, area.high))) {
            return monitor;
        }
    }
    return glfwGetPrimaryMonitor();
}

}  // namespace

GlfwLibrary::GlfwLibrary() {
    glfwSetErrorCallback([](int /* code */, const char* text) { lastComplaint = text; });
#ifdef GLFW_PLATFORM  // since GLFW 3.4, which otherwise tries Wayland first
    glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
    if (glfwInit() != GLFW_TRUE) {
        throw InputError("--gl glfw: GLFW does not start: " + lastComplaint);
    }
}

GlfwLibrary::~GlfwLibrary() { glfwTerminate(); }

std::string GlfwLibrary::complaint() const { return lastComplaint.empty() ? "no reason given" : lastComplaint; }

void GlfwWindow::Destroy::operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
void GlfwWindow::Destroy::operator()(GLFWcursor* cursor) const { glfwDestroyCursor(cursor); }

GlfwWindow::GlfwWindow(const GlfwLibrary& library, const std::string& display) {
    hintContext(false);
    open(library, display, nullptr, nullptr);
}

GlfwWindow::GlfwWindow(const GlfwLibrary& library, const std::string& display, const WindowRequest& wanted,
                       const PlatformRequest& request, GLFWwindow* share)
    : wanted_(wanted), refreshHz_(request.eyesInTurn ? request.refreshHz : 0) {
    GLFWmonitor* monitor = nullptr;
    hintContext(false);
    if (!isPlaced()) {
        glfwWindowHint(GLFW_DECORATED, GLFW_TRUE);
    }
    if (wanted.follows) {
        glfwWindowHint(GLFW_RESIZABLE, GLFW_TRUE);
        wanted_.pixels = firstSize(wanted.pixels);
    }
    if (!wanted.output.monitor.empty()) {
        monitor = monitorNamed(wanted, display);
        requireMode(monitor, wanted);
        refreshRate_ = refreshRateOf(monitor, wanted, refreshHz_);
        glfwWindowHint(GLFW_REFRESH_RATE, refreshRate_);
    }
    if (request.eyesInTurn) {
        glfwWindowHint(GLFW_STEREO, GLFW_TRUE);
        window_.reset(glfwCreateWindow(wanted_.pixels.x, wanted_.pixels.y, wanted_.title.c_str(), monitor, share));
        quadBuffers_ = window_ != nullptr;
        glfwWindowHint(GLFW_STEREO, GLFW_FALSE);
    }
    if (window_ == nullptr) {
        open(library, display, monitor, share);
    }
    if (monitor == nullptr) {
        if (!isPlaced()) {
            setIcon(handle());
        }
        if (wanted.output.window) {
            glfwSetWindowPos(handle(), wanted.output.window->x, wanted.output.window->y);
        }
        glfwShowWindow(handle());
    }
    glfwSetInputMode(handle(), GLFW_CURSOR, GLFW_CURSOR_HIDDEN);
}

void GlfwWindow::open(const GlfwLibrary& library, const std::string& display, GLFWmonitor* monitor, GLFWwindow* share) {
    window_.reset(glfwCreateWindow(wanted_.pixels.x, wanted_.pixels.y, wanted_.title.c_str(), monitor, share));
    if (window_ == nullptr) {
        throw InputError((name().empty() ? "--gl glfw" : "output " + name()) +
                         ": no window with OpenGL 3.3 on display " + display + ": " + library.complaint());
    }
}

void GlfwWindow::sendInputTo(const std::shared_ptr<WindowInput>& input, std::size_t index, bool pointer) {
    listener_ = std::make_unique<Listener>(Listener{.input = input, .window = index, .pixels = wanted_.pixels});
    glfwSetWindowUserPointer(handle(), listener_.get());
    followKeys();
    glfwSetWindowRefreshCallback(
        handle(), [](GLFWwindow* window) { static_cast<Listener*>(glfwGetWindowUserPointer(window))->exposed = true; });
    if (pointer) {
        followPointer();
    }
    if (wanted_.follows) {
        followSize();
    }
}

/// The window manager may already have chosen another size.
void GlfwWindow::followSize() {
    glfwGetFramebufferSize(handle(), &listener_->pixels.x, &listener_->pixels.y);
    glfwSetFramebufferSizeCallback(handle(), [](GLFWwindow* window, int width, int height) {
        auto* listener = static_cast<Listener*>(glfwGetWindowUserPointer(window));
        listener->pixels = {width, height};
        listener->exposed = true;
    });
}

/// GLFW switches to a window by itself if the monitor goes away.
void GlfwWindow::toggleFullScreen(GLFWwindow* window) {
    auto* listener = static_cast<Listener*>(glfwGetWindowUserPointer(window));
    glm::ivec2 &place = listener->placeBefore, &size = listener->sizeBefore;
    if (glfwGetWindowMonitor(window) != nullptr) {
        glfwSetWindowMonitor(window, nullptr, place.x, place.y, size.x, size.y, GLFW_DONT_CARE);
        return;
    }
    GLFWmonitor* monitor = monitorOf(window);
    const GLFWvidmode* mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor);
    if (mode != nullptr) {
        glfwGetWindowPos(window, &place.x, &place.y);
        glfwGetWindowSize(window, &size.x, &size.y);
        glfwSetWindowMonitor(window, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
    }
}

bool GlfwWindow::leave(GLFWwindow* window) {
    auto& listener = *static_cast<Listener*>(glfwGetWindowUserPointer(window));
    if (std::exchange(listener.stroke, false)) {
        addPointer(window, PointerEvent::Kind::release);
        return true;
    }
    const bool full = glfwGetWindowAttrib(window, GLFW_RESIZABLE) != 0 && glfwGetWindowMonitor(window) != nullptr;
    if (full) {
        toggleFullScreen(window);
    }
    return full;
}

/// Each press is a key event. If it types a character, a character event follows.
void GlfwWindow::followKeys() {
    glfwSetKeyCallback(handle(), [](GLFWwindow* window, int key, int scancode, int action, int modifiers) {
        if (action != GLFW_RELEASE) {
            auto& listener = *static_cast<Listener*>(glfwGetWindowUserPointer(window));
            const char* name = glfwGetKeyName(key, scancode);
            if (key == GLFW_KEY_F11 && action == GLFW_PRESS && glfwGetWindowAttrib(window, GLFW_RESIZABLE) != 0) {
                toggleFullScreen(window);
            }
            if (key == GLFW_KEY_ESCAPE && action == GLFW_PRESS && leave(window)) {
                return;
            }
            listener.key = {key, modifiers, action == GLFW_REPEAT, name == nullptr ? "" : name};
            listener.add(pressedKey(listener.key));
        }
    });
    glfwSetCharCallback(handle(), [](GLFWwindow* window, unsigned character) {
        auto& listener = *static_cast<Listener*>(glfwGetWindowUserPointer(window));
        listener.add(typedKey(character, listener.key));
    });
}

bool GlfwWindow::takeExposed() { return std::exchange(listener_->exposed, false); }

/// Adds an event of the pointer at the place of its last motion. glfwGetCursorPos() would ask the X server, and return
/// a later place.
void GlfwWindow::addPointer(GLFWwindow* window, PointerEvent::Kind kind, double notches) {
    const auto* listener = static_cast<Listener*>(glfwGetWindowUserPointer(window));
    const auto isDown = [&](int key) { return glfwGetKey(window, key) == GLFW_PRESS; };
    const bool shift = isDown(GLFW_KEY_LEFT_SHIFT) || isDown(GLFW_KEY_RIGHT_SHIFT);
    const bool control = isDown(GLFW_KEY_LEFT_CONTROL) || isDown(GLFW_KEY_RIGHT_CONTROL);
    listener->input->pointer.push_back(
        {kind, listener->window, listener->at, host::monotonicNs(), notches, shift, control});
}

void GlfwWindow::followPointer() {
    using Kind = PointerEvent::Kind;
    glfwSetInputMode(handle(), GLFW_CURSOR, GLFW_CURSOR_NORMAL);
    cursor_.reset(glfwCreateStandardCursor(GLFW_CROSSHAIR_CURSOR));
    glfwSetCursor(handle(), cursor_.get());  // without a crosshair, the arrow stays
    glfwSetMouseButtonCallback(handle(), [](GLFWwindow* window, int button, int action, int modifiers) {
        const bool down = action == GLFW_PRESS;
        const bool pans = button == GLFW_MOUSE_BUTTON_MIDDLE || (modifiers & GLFW_MOD_SHIFT) != 0;
        if (button == GLFW_MOUSE_BUTTON_LEFT) {
            auto& listener = *static_cast<Listener*>(glfwGetWindowUserPointer(window));
            if (std::exchange(listener.stroke, down) || down) {  // after Escape, the release has come before
                addPointer(window, down ? Kind::press : Kind::release);
            }
        } else if (button == GLFW_MOUSE_BUTTON_RIGHT || button == GLFW_MOUSE_BUTTON_MIDDLE) {
            addPointer(window, !down ? Kind::viewRelease : pans ? Kind::panPress : Kind::turnPress);
        }
    });
    glfwSetScrollCallback(
        handle(), [](GLFWwindow* window, double /* right */, double up) { addPointer(window, Kind::wheel, -up); });
    glfwSetCursorPosCallback(handle(), [](GLFWwindow* window, double x, double y) {
        static_cast<Listener*>(glfwGetWindowUserPointer(window))->at = {x, y};
        addPointer(window, Kind::move);
    });
}

void GlfwWindow::addShortcomings(std::vector<std::string>& lines) const {
    const std::string output = "output " + name() + ": ";
    glm::ivec2 size;
    glfwGetFramebufferSize(handle(), &size.x, &size.y);
    ScreenRect area;
    glfwGetWindowPos(handle(), &area.low.x, &area.low.y);
    area.high = area.low + size;
    if (size != wanted_.pixels && !wanted_.follows) {
        lines.push_back(output + "the window manager made its window " + sizeText(size) + " pixels instead of " +
                        sizeText(wanted_.pixels));
    }
    if (wanted_.output.monitor.empty() && wanted_.output.window && area.low != *wanted_.output.window) {
        lines.push_back(output + "the window manager put its window at " + placeText(area.low) + " instead of " +
                        placeText(*wanted_.output.window));
    }
    const std::int64_t hidden = hiddenPixels(area, lightedAreas());
    if (hidden > 0) {
        lines.push_back(output + "its window of " + sizeText(size) + " pixels at " + placeText(area.low) +
                        " lies partly off the screen: " + std::to_string(hidden) + " pixels are on no monitor");
    }
    GLFWmonitor* monitor = glfwGetWindowMonitor(handle());
    const GLFWvidmode* mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor);
    if (mode != nullptr && refreshHz_ > 0 && mode->refreshRate > 0 && std::abs(mode->refreshRate - refreshHz_) > 1) {
        lines.push_back(output + "monitor " + wanted_.output.monitor + " runs at " + std::to_string(mode->refreshRate) +
                        " Hz instead of " + std::to_string(std::lround(refreshHz_)));
    }
}

ScreenRect workArea() {
    GLFWmonitor* first = glfwGetPrimaryMonitor();
    if (first == nullptr) {
        return lightedAreas().front();
    }
    ScreenRect area;
    glm::ivec2 size;
    glfwGetMonitorWorkarea(first, &area.low.x, &area.low.y, &size.x, &size.y);
    area.high = area.low + size;
    return area;
}

int displayScreen() { return DefaultScreen(glfwGetX11Display()); }

}  // namespace render_node
