// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "web/hand/dug_session.hpp"

// What keys and the wheel change in the page, by the rules of a wall's window (haptic_bridge/hand/tool_keys.hpp).
namespace web {

/// Changes the tool or the material of `session` by `notches`. `what` is "size", "heading" or "humidity". A round tool
/// has no heading and stays as it is. Throws base::InputError for another word, and as DugSession::setTool() does.
void changeByNotches(DugSession& session, std::string_view what, double notches);
/// Gives a tool that is too small to be seen the usual size of the field.
void enlargeTool(DugSession& session);

}  // namespace web
