// SPDX-License-Identifier: Apache-2.0
#include "tests/support/screens/x_monitors.hpp"

#include <X11/Xlib.h>
#include <X11/extensions/Xrandr.h>

#include <algorithm>
#include <span>
#include <stdexcept>

namespace support {
namespace {

template <class Info>
using Owned = std::unique_ptr<Info, void (*)(Info*)>;

/// A monitor as the server knows it. The mode and the controller (CRTC) are None if it is off.
struct Known {
    Owned<XRRScreenResources> resources;
    RROutput output = None;
    Owned<XRROutputInfo> info;

    [[nodiscard]] bool fits(RRMode mode, glm::ivec2 size) const {
        const std::span modes(resources->modes, static_cast<std::size_t>(resources->nmode));
        return std::ranges::any_of(modes, [&](const XRRModeInfo& known) {
            return known.id == mode && glm::ivec2(known.width, known.height) == size;
        });
    }
    [[nodiscard]] std::span<const RRMode> modes() const { return {info->modes, static_cast<std::size_t>(info->nmode)}; }
    /// Returns the monitor's mode of this size.
    [[nodiscard]] RRMode modeOf(glm::ivec2 size) const {
        const auto found = std::ranges::find_if(modes(), [&](RRMode mode) { return fits(mode, size); });
        if (found == modes().end()) {
            throw std::runtime_error("the monitor has no such mode");
        }
        return *found;
    }
    /// Returns the monitor's controller, or a free one if it is off.
    [[nodiscard]] RRCrtc controller(Display* display) const {
        if (info->crtc != None) {
            return info->crtc;
        }
        for (const RRCrtc one : std::span(info->crtcs, static_cast<std::size_t>(info->ncrtc))) {
            const Owned<XRRCrtcInfo> use(XRRGetCrtcInfo(display, resources.get(), one), XRRFreeCrtcInfo);
            if (use != nullptr && use->noutput == 0) {
                return one;
            }
        }
        throw std::runtime_error("no free controller for the monitor");
    }
};

Known knownAs(Display* display, Window root, const std::string& monitor) {
    Known known{{XRRGetScreenResources(display, root), XRRFreeScreenResources}, None, {nullptr, XRRFreeOutputInfo}};
    for (const RROutput output :
         std::span(known.resources->outputs, static_cast<std::size_t>(known.resources->noutput))) {
        known.info = {XRRGetOutputInfo(display, known.resources.get(), output), XRRFreeOutputInfo};
        known.output = output;
        if (known.info != nullptr && monitor == known.info->name) {
            return known;
        }
    }
    throw std::runtime_error("the X server has no monitor " + monitor);
}

/// Makes the server look at its monitors, as xrandr does. The dummy driver notices only then that one is on.
void probe(Display* display, Window root) {
    const Owned<XRRScreenResources> resources(XRRGetScreenResources(display, root), XRRFreeScreenResources);
    XSync(display, False);
}

}  // namespace

void XMonitors::Close::operator()(_XDisplay* display) const { XCloseDisplay(display); }

XMonitors::XMonitors(const std::string& display) : display_(XOpenDisplay(display.c_str())) {
    if (display_ == nullptr) {
        throw std::runtime_error("the test cannot open display " + display);
    }
    root_ = DefaultRootWindow(display_.get());
}

void XMonitors::setScreen(glm::ivec2 size) const {
    XRRSetScreenSize(display_.get(), root_, size.x, size.y, size.x / 4, size.y / 4);  // 4 pixels per millimetre
    XSync(display_.get(), False);
}

void XMonitors::addMode(const std::string& monitor, glm::ivec2 size) const {
    const Known known = knownAs(display_.get(), root_, monitor);
    std::string name = "test-" + std::to_string(size.x) + "x" + std::to_string(size.y);
    XRRModeInfo mode{};
    mode.width = static_cast<unsigned>(size.x);
    mode.height = static_cast<unsigned>(size.y);
    mode.hTotal = mode.width + 160;
    mode.hSyncStart = mode.width + 16;
    mode.hSyncEnd = mode.width + 80;
    mode.vTotal = mode.height + 14;
    mode.vSyncStart = mode.height + 3;
    mode.vSyncEnd = mode.height + 8;
    mode.dotClock = 60UL * mode.hTotal * mode.vTotal;
    mode.name = name.data();
    mode.nameLength = static_cast<unsigned>(name.size());
    const std::span modes(known.resources->modes, static_cast<std::size_t>(known.resources->nmode));
    const auto before = std::ranges::find_if(modes, [&](const XRRModeInfo& one) { return name == one.name; });
    XRRAddOutputMode(display_.get(), known.output,
                     before == modes.end() ? XRRCreateMode(display_.get(), root_, &mode) : before->id);
    XSync(display_.get(), False);
}

void XMonitors::removeMode(const std::string& monitor, glm::ivec2 size) const {
    const Known known = knownAs(display_.get(), root_, monitor);
    for (const RRMode mode : known.modes()) {
        if (known.fits(mode, size)) {
            XRRDeleteOutputMode(display_.get(), known.output, mode);
        }
    }
    XSync(display_.get(), False);
}

void XMonitors::show(const std::vector<Place>& places) const {
    XGrabServer(display_.get());
    bool refused = false;
    for (const Place& place : places) {
        const Known known = knownAs(display_.get(), root_, place.monitor);
        RROutput output = known.output;
        refused = XRRSetCrtcConfig(display_.get(), known.resources.get(), known.controller(display_.get()), CurrentTime,
                                   place.low.x, place.low.y, known.modeOf(place.size), RR_Rotate_0, &output,
                                   1) != RRSetConfigSuccess ||
                  refused;
    }
    XUngrabServer(display_.get());
    probe(display_.get(), root_);
    if (refused) {
        throw std::runtime_error("the X server keeps a monitor as it was");
    }
}

void XMonitors::switchOff(const std::string& monitor) const {
    const Known known = knownAs(display_.get(), root_, monitor);
    if (XRRSetCrtcConfig(display_.get(), known.resources.get(), known.controller(display_.get()), CurrentTime, 0, 0,
                         None, RR_Rotate_0, nullptr, 0) != RRSetConfigSuccess) {
        throw std::runtime_error("the X server keeps a monitor on");
    }
    probe(display_.get(), root_);
}

XMonitors::Place XMonitors::placeOf(unsigned long window) const {
    XWindowAttributes attributes{};
    Place place;
    if (XGetWindowAttributes(display_.get(), window, &attributes) != 0 && attributes.map_state == IsViewable) {
        Window child = None;
        XTranslateCoordinates(display_.get(), window, root_, 0, 0, &place.low.x, &place.low.y, &child);
        place.size = {attributes.width, attributes.height};
    }
    return place;
}

}  // namespace support
