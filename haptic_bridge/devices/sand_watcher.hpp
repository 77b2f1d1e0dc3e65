// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/replica.hpp"

namespace haptic_bridge {

/// A device that shows the sand. The sand thread calls stepped() after its steps. stepped() copies what it needs and
/// never waits.
class SandWatcher {
public:
    SandWatcher() = default;
    virtual ~SandWatcher() = default;
    SandWatcher(const SandWatcher&) = delete;
    SandWatcher& operator=(const SandWatcher&) = delete;
    virtual void stepped(const sand::Replica& terrain) = 0;
};

}  // namespace haptic_bridge
