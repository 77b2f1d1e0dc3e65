// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <string>
#include <vector>

#include "haptic_bridge/link/handshake.hpp"
#include "haptic_bridge/link/security.hpp"
#include "haptic_bridge/server/round_trips.hpp"
#include "haptic_bridge/server/sand_thread.hpp"

namespace haptic_bridge {

/// Settings and callbacks of a server that all connections share. All of it is used on the thread that runs `io`.
struct Service {
    boost::asio::io_context& io;
    Identity identity = {};
    std::uint32_t stepsPerSecond = 0;
    std::function<Report()> report = {};               // the parts of a report that the link does not measure itself
    std::function<void(const std::string&)> log = {};  // one line for a person
    /// Pieces of the tick track that are there for the master's journal; with `all`, waits for the last ones. Empty
    /// where nothing is recorded.
    std::function<std::vector<base::Bytes>(bool all)> ticks = {};
    std::function<void(double share)> shareForce = {};  // an operator's wish
    TimingTests tests = {};
    LinkSecurity security = {};
    SandThread* sandThread = nullptr;  // from Listener::serve() on
};

}  // namespace haptic_bridge
