// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "walls/wall.hpp"

namespace walls {

/// Returns a text that is equal for two places whose windows are on the same screen of the same X server. It is as
/// exact as their hosts and displays are.
///
/// So ":0", ":0.0", "unix:0" and ":00" of one host are equal, and so is "node1:0" from any host. Names of hosts have no
/// upper case. A place without a display has $DISPLAY, which a wall file does not know; it equals only such a place of
/// the same host.
///
/// @param host  Machine of the place. It may be another text than place.host if the place names no host.
[[nodiscard]] std::string xScreenOf(const Place& place, const std::string& host);
[[nodiscard]] inline std::string xScreenOf(const Place& place) { return xScreenOf(place, place.host); }

}  // namespace walls
