// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "tracking/head_tracker.hpp"

namespace tracking {

/// Sensor 0 of a VRPN tracker, in metres; in a build without VRPN it throws base::InputError, which says so.
[[nodiscard]] std::unique_ptr<HeadTracker> openVrpn(const Source& source, const RoomMapping& mapping, Say say,
                                                    Clock clock);

}  // namespace tracking
