// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "haptic_bridge/client/client.hpp"
#include "host/print_line.hpp"
#include "master/steps/tick_budget.hpp"

namespace master {

/// The tick tracks of all servers of a session. Leaves out pieces beyond the TickBudget. Used by one thread.
class ServerTicks {
public:
    /// `fastStepsPerSecond` is as in TickBudget.
    ServerTicks(int fastStepsPerSecond, std::int64_t nowNs) : budget_(fastStepsPerSecond, nowNs) {}

    /// Counts a step of the server.
    void step() { budget_.step(); }
    /// Takes the pieces that `client` has received since the last call. `server` names it in messages.
    void collect(haptic_bridge::Client& client, const std::string& server, std::int64_t nowNs) {
        for (base::Bytes& piece : client.drainTicks()) {
            if (budget_.take(piece.size(), nowNs)) {
                pieces_.push_back(std::move(piece));
            } else if (budget_.refused() == 1) {
                host::printLine(
                    "haptic link: {} sends more ticks than a hand can make; the journal leaves out those beyond",
                    server);
            }
        }
    }
    /// Returns the pieces that were collected since the last call.
    [[nodiscard]] std::vector<base::Bytes> take() { return std::exchange(pieces_, {}); }
    /// Prints how many pieces were left out, if any.
    void printLeftOut() const {
        if (budget_.refused() > 0) {
            host::printLine("haptic link: the journal has left out {} pieces of ticks", budget_.refused());
        }
    }

private:
    TickBudget budget_;
    std::vector<base::Bytes> pieces_;
};

}  // namespace master
