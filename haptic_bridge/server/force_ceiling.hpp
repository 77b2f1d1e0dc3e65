// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>

#include "haptic_bridge/link/protocol.hpp"

namespace haptic_bridge {

/// Share of the force that the command line of a server allows, 0 to 1.
struct OwnForce {
    double share = 1;  // --force and --force-scale
    /// --force-until-ctl: an operator of the linked session may go beyond `share`. Only the command line can say so,
    /// and no message.
    bool untilOperator = false;

    /// Returns the share that no message lifts.
    [[nodiscard]] double ceiling() const { return untilOperator ? 1 : share; }
};

/// Returns the share of its force that the hand feels, 0 to 1. `sent` is the share that the linked master has sent;
/// nullopt without a master.
[[nodiscard]] inline double feltShare(const OwnForce& own, const std::optional<ForceShare>& sent) {
    if (!sent) {
        return 0;
    }
    return std::min(sent->share, sent->byOperator ? own.ceiling() : own.share);
}

}  // namespace haptic_bridge
