// SPDX-License-Identifier: Apache-2.0
#include "master/steps/server_link.hpp"

#include <chrono>
#include <utility>

#include "host/event.hpp"
#include "host/print_line.hpp"

namespace master {

ServerLink::ServerLink(std::optional<haptic_bridge::Address> server, haptic_bridge::Offer offer,
                       haptic_bridge::LinkSecurity security, haptic_bridge::LinkClock clock, int fastStepsPerSecond)
    : server_(std::move(server)),
      offer_(std::move(offer)),
      security_(std::move(security)),
      now_(std::move(clock)),
      ticks_(fastStepsPerSecond, now_()) {}

void ServerLink::connect() {
    client_ = std::make_unique<haptic_bridge::Client>(*server_, offer_, security_, now_);
    client_->shareForce(share_);
}

void ServerLink::leave(const std::string& why) {
    ticks_.collect(*client_, address(), now_());
    earlierReport_ = report();
    earlierFailure_ = why.empty() ? client_->lastFailure() : why;
    earlierLinks_ = counters();
    ++earlierLinks_.reconnects;
    client_->stop();
    client_.reset();
    changes_ = 0;
    loaded_ = 0;
    trippedTicks_.reset();
    tripped_ = false;
}

/// Compares the last report with the one before.
void ServerLink::followReports() {
    const auto latest = client_->report();
    if (!latest || (trippedTicks_ && latest->handTicks == handTicks_)) {
        return;
    }
    const std::uint64_t ticks = latest->guards[static_cast<std::size_t>(haptic_bridge::Guard::tripped)];
    tripped_ = trippedTicks_ && ticks > *trippedTicks_;
    trippedTicks_ = ticks;
    handTicks_ = latest->handTicks;
}

haptic_bridge::LinkStatus ServerLink::follow(std::uint32_t epoch) {
    followReports();
    haptic_bridge::LinkStatus status = client_->link();
    if (const bool loads = status.link == haptic_bridge::Link::loading; loads && status.loaded != loaded_) {
        loaded_ = status.loaded;
        const double share = static_cast<double>(loaded_) / haptic_bridge::Loading::kAll;
        host::emitEvent(
            "link", {{"state", base::nameOf(status.link)}, {"epoch", epoch}, {"server", address()}, {"share", share}});
    }
    if (status.changes != changes_) {
        changes_ = status.changes;
        host::emitEvent("link", {{"state", base::nameOf(status.link)}, {"epoch", epoch}, {"server", address()}});
        if (!status.message.empty()) {
            host::printLine("haptic link: {}", status.message);
        }
    }
    return status;
}

void ServerLink::shareForce(double share) {
    share_ = {share, true};
    if (client_) {
        client_->shareForce(share_);
    }
}

void ServerLink::startDrills() {
    for (const lockstep::Fault& fault : std::exchange(drills_, {})) {
        const bool silence = fault.kind == lockstep::Fault::Kind::partition;
        client_->drill(silence ? haptic_bridge::LinkDrill::silence : haptic_bridge::LinkDrill::garbage,
                       std::chrono::milliseconds(fault.milliseconds));
    }
}

std::vector<base::Bytes> ServerLink::ticks() {
    if (client_) {
        ticks_.collect(*client_, address(), now_());
    }
    return ticks_.take();
}

std::optional<haptic_bridge::Report> ServerLink::report() const {
    const auto latest = client_ ? client_->report() : std::nullopt;
    return latest ? latest : earlierReport_;
}

std::string ServerLink::lastRefusal() const {
    const std::string latest = client_ ? client_->lastFailure() : "";
    return latest.empty() ? earlierFailure_ : latest;
}

haptic_bridge::LinkCounters ServerLink::counters() const {
    haptic_bridge::LinkCounters sum = earlierLinks_;
    if (client_) {
        sum.add(client_->counters());
    }
    return sum;
}

}  // namespace master
