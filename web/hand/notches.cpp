// SPDX-License-Identifier: Apache-2.0
#include "web/hand/notches.hpp"

#include <fmt/format.h>

#include "base/input_error.hpp"
#include "haptic_bridge/hand/tool_keys.hpp"

namespace web {

using haptic_bridge::ToolLimits;

void changeByNotches(DugSession& session, std::string_view what, double notches) {
    const scene::Material& now = session.material();
    if (what == "size") {
        session.setTool({.radius = ToolLimits::of(session.scene()).resized(now.toolRadius, notches)});
    } else if (what == "humidity") {
        session.setNumber(what, haptic_bridge::moistened(now.humidity, notches * haptic_bridge::kMoreHumidity));
    } else if (what != "heading") {
        throw base::InputError(fmt::format("a notch cannot change '{}'", what));
    } else if (!sand::isRound(now.toolKind)) {
        session.setTool({.heading = haptic_bridge::turned(now.toolHeading, notches * haptic_bridge::kTurnDegrees)});
    }
}

void enlargeTool(DugSession& session) {
    const double usual = ToolLimits::of(session.scene()).usual;
    if (session.material().toolRadius < usual) {
        session.setTool({.radius = usual});
    }
}

}  // namespace web
