// SPDX-License-Identifier: Apache-2.0
// Messages while a server numbers the steps. Steps and timing tests come from the server; the master reports which step
// the wall shows.
#include <fmt/format.h>

#include <boost/asio/post.hpp>
#include <utility>

#include "haptic_bridge/client/connection_thread.hpp"
#include "host/clock.hpp"

namespace haptic_bridge {

namespace asio = boost::asio;

void Client::Conversation::take(Link, const TimingTest& test) {
    connection_->send(TimingEcho{test.id, Leg::received});
    shelf.addTest(test.id, grant_ ? grant_->lastStep() : 0);
}

void Client::Conversation::take(Link link, StepMessage& message) {
    if (const std::string why = message.step.refusal(limits_); !why.empty()) {
        connection_->close(why, RefusalCode::garbage);
        return;
    }
    const std::uint64_t number = message.step.number, last = grant_ ? grant_->lastStep() : 0;
    switch (grant_ && link == Link::linked ? grant_->arrived(message.step) : Grant::Arrival::foreign) {
        case Grant::Arrival::foreign:
            shelf.count([](LinkCounters& counters) { ++counters.stepsForeign; });
            break;
        case Grant::Arrival::stale:
            shelf.count([](LinkCounters& counters) { ++counters.stepsStale; });
            break;
        case Grant::Arrival::afterGap:
            connection_->close(fmt::format("step {} came after step {}", number, last));
            break;
        case Grant::Arrival::unasked:
            connection_->close(fmt::format("step {} holds an edit that the master has not asked for", number),
                               RefusalCode::garbage);
            break;
        case Grant::Arrival::next:
            if (shelf.add(
                    TimedStep{std::move(message.step), message.serverTimeNs, message.stateHash, host::monotonicNs()})) {
                connection_->pause();
            }
            break;
    }
}

void Client::Conversation::take(Link, TickPiece& piece) { shelf.addTicks(std::move(piece.bytes)); }

std::vector<TimedStep> Client::Conversation::drain(std::size_t most) {
    bool resume = false;
    std::vector<TimedStep> steps = shelf.drain(most, resume);
    if (resume) {
        resumeReading();
    }
    return steps;
}

void Client::Conversation::resumeReading() {
    asio::post(io_, [this] {
        if (connection_ && !drill_.active()) {
            connection_->resume();
        }
    });
}

void Client::Conversation::shown(const Shown& frame) {
    asio::post(io_, [this, frame, tests = shelf.takeTestsInFrame()] {
        if (!connection_ || drill_.active() || shelf.link() != Link::linked) {
            return;
        }
        const auto connection = connection_;  // a copy, because sending may close the connection
        connection->send(grant_->bounded(frame));
        for (const std::uint32_t id : tests) {
            connection->send(TimingEcho{id, Leg::shown});
        }
    });
}

}  // namespace haptic_bridge
