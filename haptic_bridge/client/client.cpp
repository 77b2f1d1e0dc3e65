// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/client/client.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <random>
#include <utility>

#include "haptic_bridge/client/connection_thread.hpp"
#include "host/clock.hpp"

namespace haptic_bridge {

void LinkCounters::add(const LinkCounters& other) {
    links += other.links;
    reconnects += other.reconnects;
    bytesIn += other.bytesIn;
    bytesOut += other.bytesOut;
    stepsIn += other.stepsIn;
    stepsStale += other.stepsStale;
    stepsForeign += other.stepsForeign;
    catchUps += other.catchUps;
    snapshots += other.snapshots;
    for (std::size_t i = 0; i < refused.size(); ++i) {
        refusedHere[i] += other.refusedHere[i];
        refused[i] += other.refused[i];
    }
}

Client::Client(Address address, Offer offer, LinkSecurity security, LinkClock clock)
    : conversation_(std::make_unique<Conversation>(std::move(address), std::move(offer), std::move(security),
                                                   std::move(clock))) {}

Client::~Client() = default;

LinkStatus Client::link() const { return conversation_->shelf.status(); }

void Client::grant(std::uint32_t epoch, std::uint64_t stepNumber, std::uint64_t stateHash, StepRing recent) {
    conversation_->grant({epoch, stepNumber, stateHash}, std::move(recent));
}

bool Client::needsState() const { return conversation_->shelf.needsState(); }

void Client::giveState(base::Bytes state) { conversation_->giveState(std::move(state)); }

std::vector<TimedStep> Client::drain(std::size_t most) { return conversation_->drain(most); }

void Client::shown(const Shown& frame) { conversation_->shown(frame); }

void Client::request(const sand::Edit& edit) { conversation_->request({edit}); }

void Client::shareForce(const ForceShare& share) { conversation_->shareForce(share); }

std::vector<base::Bytes> Client::drainTicks() { return conversation_->shelf.drainTicks(); }

std::vector<TimedPosition> Client::drainPositions() { return conversation_->drainPositions(); }

std::uint64_t Client::floods() const { return conversation_->shelf.floods(); }

std::int64_t Client::clockOffsetNs() const { return conversation_->shelf.clockOffsetNs(); }

std::optional<Report> Client::report() const { return conversation_->shelf.report(); }

LinkCounters Client::counters() const { return conversation_->shelf.counters(); }

std::string Client::lastFailure() const { return conversation_->shelf.failure(); }

std::uint32_t Client::stepsPerSecond() const { return conversation_->shelf.stepsPerSecond(); }

std::optional<double> Client::forceCeiling() const { return conversation_->shelf.forceCeiling(); }

void Client::drill(LinkDrill drill, std::chrono::milliseconds length) { conversation_->drill(drill, length); }

void Client::stop() { conversation_->stop(); }

// Link with a server that has no sand and streams positions of its hand.

void Client::Conversation::take(Link link, const PositionGreeting& greeting) {
    if (isUp(link)) {
        outOfTurn();
        return;
    }
    if (greeting.protocol != kProtocolVersion) {
        refuse(fmt::format("refused: it streams positions in protocol version {}, the master has version {}; "
                           "docs/protocol.md describes the master's",
                           greeting.protocol, kProtocolVersion),
               RefusalCode::protocol);
        return;
    }
    if (!greeter_.accepts(greeting)) {
        refuse("refused: " + greeter_.because().text, greeter_.because().code);
        return;
    }
    countLink();
    shelf.dropPositions();
    retryPause_.linked(host::monotonicNs());
    shelf.setStatus(Link::streaming, fmt::format("{}: connected, '{}' streams positions; the master numbers the steps",
                                                 peer(), greeting.name));
}

void Client::Conversation::take(Link link, const Position& position) {
    if (link != Link::streaming) {
        outOfTurn();
    } else if (shelf.add(TimedPosition{position, host::monotonicNs()})) {
        connection_->pause();
    }
}

std::vector<TimedPosition> Client::Conversation::drainPositions() {
    bool resume = false;
    std::vector<TimedPosition> positions = shelf.drainPositions(resume);
    if (resume) {
        resumeReading();
    }
    return positions;
}

// Drills: faults of the link on purpose.

void Client::Conversation::drill(LinkDrill drill, std::chrono::milliseconds length) {
    boost::asio::post(io_, [this, drill, length] {
        if (!connection_) {
            return;
        }
        if (drill == LinkDrill::garbage) {
            std::minstd_rand noise;
            base::Bytes bytes(4096);
            std::generate(bytes.begin(), bytes.end(), [&] { return static_cast<std::uint8_t>(noise() >> 8); });
            connection_->sendBytes(std::move(bytes));
            return;
        }
        connection_->pause();
        drill_.start(length, [this] {
            if (connection_) {
                connection_->resume();
            }
        });
    });
}

}  // namespace haptic_bridge
