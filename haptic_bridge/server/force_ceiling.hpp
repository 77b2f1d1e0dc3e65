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
/// @param sent     The share that the linked master has sent; nullopt without a master.
[[nodiscard]] inline double feltShare(double ceiling, const std::optional<ForceShare>& sent) {
    if (!sent) {
        return 0;
    }
    return sent->byOperator ? sent->share : std::min(sent->share, ceiling);
}

}  // namespace haptic_bridge
