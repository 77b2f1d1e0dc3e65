// SPDX-License-Identifier: Apache-2.0
// The link with a server that has no sand and streams where its hand is.
#include <fmt/format.h>

#include <utility>

#include "haptic_bridge/client/connection_thread.hpp"
#include "host/clock.hpp"

namespace haptic_bridge {

void Client::Session::greet(const PositionGreeting& greeting) {
    if (up()) {
        connection_->close("it sent a message out of turn", RefusalCode::garbage);
        return;
    }
    if (greeting.protocol != kProtocolVersion) {
        refuse(fmt::format("refused: it streams positions in protocol version {}, the master speaks {}; "
                           "docs/protocol.md has the present one",
                           greeting.protocol, kProtocolVersion),
               RefusalCode::protocol);
        return;
    }
    if (!handshake_->accepts(greeting)) {
        refuse("refused: " + handshake_->because().text, handshake_->because().code);
        return;
    }
    {
        const std::lock_guard lock(shelf.mutex);
        ++shelf.counters.links;
        shelf.counters.reconnects += everWelcomed_ ? 1 : 0;
        shelf.positions.clear();
    }
    everWelcomed_ = true;
    backOff_ = kFirstBackOff;
    tell(Link::streaming,
         fmt::format("{}: connected, '{}' streams positions; the master numbers the steps", peer_, greeting.name));
}

void Client::Session::accept(const Position& position) {
    bool full = false;
    {
        const std::lock_guard lock(shelf.mutex);
        shelf.positions.push_back({position, host::monotonicNs()});
        full = shelf.positions.size() >= kMaxPositions && !shelf.full;
        shelf.full = shelf.full || full;
        shelf.floods += full ? 1 : 0;
    }
    if (full) {
        connection_->pause();
    }
}

std::vector<TimedPosition> Client::Session::drainPositions() {
    const std::lock_guard lock(shelf.mutex);
    if (shelf.full) {
        resumeReading();
    }
    return std::exchange(shelf.positions, {});
}

}  // namespace haptic_bridge
