// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/client/client.hpp"

#include <utility>

#include "haptic_bridge/client/connection_thread.hpp"

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

Client::Client(Address address, Offer offer, LinkSecurity security)
    : session_(std::make_unique<Session>(std::move(address), std::move(offer), std::move(security))) {}

Client::~Client() = default;

LinkStatus Client::link() const {
    const std::lock_guard lock(session_->shelf.mutex);
    return session_->shelf.status;
}

void Client::grant(std::uint32_t epoch, std::uint64_t stepNumber, std::uint64_t stateHash, base::Bytes state,
                   StepRing recent) {
    session_->grant({epoch, stepNumber, stateHash}, std::move(state), std::move(recent));
}

std::vector<TimedStep> Client::drain(std::size_t most) { return session_->drain(most); }

void Client::shown(std::uint64_t stepNumber, std::int64_t frameIntervalNs) {
    session_->shown({stepNumber, frameIntervalNs});
}

void Client::request(const sand::Edit& edit) { session_->request({edit}); }

void Client::shareForce(double share) { session_->shareForce(share); }

std::vector<base::Bytes> Client::drainTicks() {
    const std::lock_guard lock(session_->shelf.mutex);
    return std::exchange(session_->shelf.ticks, {});
}

std::vector<TimedPosition> Client::drainPositions() { return session_->drainPositions(); }

std::uint64_t Client::floods() const {
    const std::lock_guard lock(session_->shelf.mutex);
    return session_->shelf.floods;
}

std::int64_t Client::clockOffsetNs() const {
    const std::lock_guard lock(session_->shelf.mutex);
    return session_->shelf.clockOffsetNs;
}

std::optional<Report> Client::report() const {
    const std::lock_guard lock(session_->shelf.mutex);
    return session_->shelf.report;
}

LinkCounters Client::counters() const {
    const std::lock_guard lock(session_->shelf.mutex);
    return session_->shelf.counters;
}

std::uint32_t Client::stepsPerSecond() const {
    const std::lock_guard lock(session_->shelf.mutex);
    return session_->shelf.stepsPerSecond;
}

void Client::drill(LinkDrill drill, std::chrono::milliseconds length) { session_->drill(drill, length); }

void Client::stop() { session_->stop(); }

}  // namespace haptic_bridge
