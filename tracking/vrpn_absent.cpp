// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "base/input_error.hpp"
#include "tracking/vrpn_tracker.hpp"

namespace tracking {

// The same signature as with VRPN, where both are moved.
// NOLINTNEXTLINE(performance-unnecessary-value-param)
std::unique_ptr<HeadTracker> openVrpn(const Source& source, const RoomMapping&, Say, Clock) {
    throw base::InputError(fmt::format(
        "{}: this build has no VRPN; install its library and headers, and build again (docs/head_tracking.md)",
        source.text));
}

}  // namespace tracking
