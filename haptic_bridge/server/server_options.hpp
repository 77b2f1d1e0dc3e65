// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <string>
#include <vector>

#include "haptic_bridge/hand/pace.hpp"
#include "haptic_bridge/link/link_options.hpp"
#include "haptic_bridge/loop/guards/guards.hpp"
#include "haptic_bridge/server/round_trips.hpp"

namespace haptic_bridge {

/// Options of sandwall-haptic-server.
struct ServerOptions {
    std::string scene, device, listen = "127.0.0.1:7750", portFile, listeningFile, sceneErrorFile, timings;
    std::vector<std::string> map;
    Pace pace = Pace::realtime;
    Guards::Mode guards = Guards::Mode::on;
    int sandThreads = 1;
    TimingTests tests;
    bool endWithParent = false;
    std::string record;
    bool force = true;
    double forceScale = 1;
    bool forceUntilCtl = false;
    LinkOptions link;

    /// Adds these options to `line`.
    void addTo(host::CommandLine& line);
    /// Refuses what a real device cannot do or may not get. Call it before the device is opened. Throws
    /// base::InputError.
    void checkRealDevice() const;
};

}  // namespace haptic_bridge
