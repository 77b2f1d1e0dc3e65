// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>

#include "haptic_bridge/link/protocol.hpp"

namespace haptic_bridge {

/// Returns the share of its force that the hand feels, 0 to 1.
///
/// @param ceiling  Share that the server's own --force and --force-scale allow. Only an operator of the linked session
///                 may go beyond it.
/// @param told     The share that the linked master has told; nullopt without a master.
[[nodiscard]] inline double feltShare(double ceiling, const std::optional<ForceShare>& told) {
    if (!told) {
        return 0;
    }
    return told->byOperator ? told->share : std::min(told->share, ceiling);
}

}  // namespace haptic_bridge
