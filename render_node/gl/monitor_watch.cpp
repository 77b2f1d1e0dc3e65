// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/monitor_watch.hpp"

#include <X11/Xlib.h>
#include <X11/extensions/Xrandr.h>

#include <span>

#include "base/input_error.hpp"

namespace render_node {
namespace {

template <class Info>
using Owned = std::unique_ptr<Info, void (*)(Info*)>;

ScreenRect pictureOf(Display* display, XRRScreenResources* resources, RRCrtc controller) {
    const Owned<XRRCrtcInfo> info(controller == None ? nullptr : XRRGetCrtcInfo(display, resources, controller),
                                  XRRFreeCrtcInfo);
    if (info == nullptr || info->mode == None) {
        return {};
    }
    const glm::ivec2 low(info->x, info->y);
    return {low, low + glm::ivec2(static_cast<int>(info->width), static_cast<int>(info->height))};
}

}  // namespace

void MonitorWatch::Close::operator()(_XDisplay* display) const { XCloseDisplay(display); }

MonitorWatch::MonitorWatch(const std::string& display) : display_(XOpenDisplay(display.c_str())) {
    if (display_ == nullptr) {
        throw base::InputError("--gl glfw: cannot open X display " + display +
                               " a second time; has it too many clients?");
    }
    int firstError = 0;
    available_ = XRRQueryExtension(display_.get(), &firstEvent_, &firstError) != 0;
    if (available_) {
        XRRSelectInput(display_.get(), DefaultRootWindow(display_.get()),
                       RRScreenChangeNotifyMask | RRCrtcChangeNotifyMask | RROutputChangeNotifyMask);
        XFlush(display_.get());
    }
}

bool MonitorWatch::takeChanged() {
    bool changed = false;
    while (available_ && XPending(display_.get()) > 0) {
        XEvent event;
        XNextEvent(display_.get(), &event);
        XRRUpdateConfiguration(&event);
        changed = changed || event.type == firstEvent_ + RRNotify || event.type == firstEvent_ + RRScreenChangeNotify;
    }
    return changed;
}

std::optional<Monitor> MonitorWatch::named(const std::string& name) const {
    if (!available_) {
        return std::nullopt;
    }
    // The resources that the server knows at present. To ask the monitors themselves would take a second.
    const Owned<XRRScreenResources> resources(
        XRRGetScreenResourcesCurrent(display_.get(), DefaultRootWindow(display_.get())), XRRFreeScreenResources);
    if (resources == nullptr) {
        return std::nullopt;
    }
    for (const RROutput output : std::span(resources->outputs, static_cast<std::size_t>(resources->noutput))) {
        const Owned<XRROutputInfo> info(XRRGetOutputInfo(display_.get(), resources.get(), output), XRRFreeOutputInfo);
        if (info != nullptr && name == info->name) {
            return Monitor{info->connection != RR_Disconnected, pictureOf(display_.get(), resources.get(), info->crtc)};
        }
    }
    return std::nullopt;
}

}  // namespace render_node
