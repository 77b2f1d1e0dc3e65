// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "haptic_bridge/link/handshake.hpp"
#include "haptic_bridge/link/security.hpp"
#include "haptic_bridge/server/round_trips.hpp"
#include "haptic_bridge/server/sand_thread.hpp"

namespace haptic_bridge {

/// Settings and callbacks of a server that all its connections share. Used only on the streaming thread, which
/// runs `io`.
struct Service {
    boost::asio::io_context& io;
    Identity identity = {};
    std::uint32_t stepsPerSecond = 0;
    std::function<Report()> report = {};               // returns the parts of a report that the link does not measure
    std::function<void(const std::string&)> log = {};  // prints one line for the user
    /// Returns the pieces of the tick track that are ready for the master's journal. With `all`, waits for the last
    /// ones. Empty if nothing is recorded.
    std::function<std::vector<base::Bytes>(bool all)> ticks = {};
    /// Takes the master's share of the force. nullopt: no master is linked, and 0 is pushed.
    std::function<void(const std::optional<ForceShare>&)> shareForce = [](const auto&) {};
    double forceCeiling = 1;  // share of the force that no message lifts (OwnForce::ceiling())
    /// An operator has switched the force on, or has set a share above 0. After three faults it stays off until then.
    std::function<void()> switchOn = [] {};
    TimingTests tests = {};
    LinkSecurity security = {};
    std::size_t mostState = kMaxState;  // longest State of this scene [byte]
    std::size_t mostLoad = kMaxState;   // longest EditRequest of this scene [byte]
    SandThread* sandThread = nullptr;   // set by Listener::serve()
    /// Returns the part of the scene that has been read, of Loading::kAll. Empty when the scene is read. Until then
    /// `identity` has the versions alone, and peers get Loading in place of Welcome.
    std::function<std::uint32_t()> loading = {};
};

}  // namespace haptic_bridge
