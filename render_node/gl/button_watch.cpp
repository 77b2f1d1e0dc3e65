// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/button_watch.hpp"

namespace render_node {

using Kind = PointerEvent::Kind;

void ButtonWatch::Button::follow(const PointerEvent& event, bool presses, bool releases) {
    if (presses) {
        held = true;
        seen = missing = false;
    }
    held = held && !releases;
    last = event;
}

bool ButtonWatch::Button::isLost(bool down) {
    if (!held) {
        return false;
    }
    seen = seen || down;
    // At the first look the release may still be on its way.
    const bool lost = seen && !down && missing;
    missing = seen && !down;
    held = !lost;
    return lost;
}

void ButtonWatch::follow(std::span<const PointerEvent> events) {
    for (const PointerEvent& event : events) {
        left_.follow(event, event.kind == Kind::press, event.kind == Kind::release);
        view_.follow(event, event.kind == Kind::turnPress || event.kind == Kind::panPress,
                     event.kind == Kind::viewRelease);
        if (event.kind == Kind::press || event.kind == Kind::turnPress || event.kind == Kind::panPress) {
            looked_ = 0;
        }
    }
}

bool ButtonWatch::due(std::int64_t nowNs) const {
    return (left_.held || view_.held) && (looked_ == 0 || nowNs - looked_ >= kPause);
}

std::vector<PointerEvent> ButtonWatch::look(Down down, std::int64_t nowNs) {
    looked_ = nowNs;
    std::vector<PointerEvent> lost;
    const auto release = [&](const Button& button, Kind kind) {
        lost.push_back({kind, button.last.window, button.last.at, nowNs});
    };
    if (left_.isLost(down.left)) {
        release(left_, Kind::release);
    }
    if (view_.isLost(down.view)) {
        release(view_, Kind::viewRelease);
    }
    return lost;
}

}  // namespace render_node
