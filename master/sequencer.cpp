// SPDX-License-Identifier: Apache-2.0
#include "master/sequencer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "lockstep/cluster.hpp"

namespace master {

using haptic_bridge::Link;
using haptic_bridge::TimedStep;
using lockstep::nowNs;

Sequencer::Sequencer(std::optional<haptic_bridge::Address> server, const sand::Scene& scene, Pace pace)
    : server_(std::move(server)),
      offer_{scene.rules.digest(), scene.name},
      stepsPerSecond_(scene.rules.stepsPerSecond),
      pace_(pace),
      source_(server_ ? Source::starting : Source::own),
      startedNs_(nowNs()) {
    if (server_) {
        client_ = std::make_unique<haptic_bridge::Client>(*server_, offer_);
    } else {
        takeOver();
    }
}

void Sequencer::takeOver() {
    source_ = Source::own;
    ++epoch_;
    ownStepsOwed_ = 0;
    lastOwnNs_ = nowNs();
}

void Sequencer::sayLink(const haptic_bridge::LinkStatus& status) {
    if (status.changes != linkChanges_) {
        linkChanges_ = status.changes;
        if (!status.message.empty()) {
            fmt::print(stderr, "haptic link: {}\n", status.message);
        }
    }
}

void Sequencer::followLink(const sand::Terrain& terrain, std::uint64_t stateHash) {
    if (!client_) {
        return;
    }
    const haptic_bridge::LinkStatus status = client_->link();
    sayLink(status);
    if (status.link == Link::offered) {
        ++epoch_;
        client_->grant(epoch_, terrain.stepNumber(), stateHash, terrain.encodeState());
        source_ = Source::granting;
    } else if (status.link == Link::linked) {
        source_ = Source::server;
    } else if (source_ == Source::starting) {
        if (static_cast<double>(nowNs() - startedNs_) * 1e-9 > kStartWait) {
            fmt::print(stderr, "haptic link: nobody at {} for {:.0f} s; the wall goes on without a hand\n",
                       server_->text(), kStartWait);
            takeOver();
        }
    } else if (status.link != Link::offered && status.link != Link::granting && source_ != Source::own) {
        fmt::print(stderr, "haptic link: lost; the wall goes on without a hand\n");
        takeOver();
    }
}

std::size_t Sequencer::ownStepsDue() {
    if (pace_ == Pace::fast) {
        return 1;
    }
    const std::int64_t now = nowNs();
    ownStepsOwed_ += static_cast<double>(now - lastOwnNs_) * 1e-9 * stepsPerSecond_;
    lastOwnNs_ = now;
    const double due = std::floor(ownStepsOwed_);
    ownStepsOwed_ -= due;
    return static_cast<std::size_t>(due);
}

std::vector<TimedStep> Sequencer::next(const sand::Terrain& terrain, std::uint64_t stateHash, std::size_t most) {
    std::vector<TimedStep> steps;
    if (client_ && source_ == Source::server) {
        // Before a look at the link: what has arrived counts, even when the link has gone since.
        steps = client_->drain(most);
    }
    if (!steps.empty()) {
        return steps;
    }
    followLink(terrain, stateHash);
    if (source_ == Source::own) {
        // A wall slower than the steps does not catch up on hovering: it would only fall further behind.
        const std::size_t due = std::min(ownStepsDue(), most);
        for (std::size_t i = 0; i < due; ++i) {
            TimedStep& own = steps.emplace_back();
            own.step.epoch = epoch_;
            own.step.number = terrain.stepNumber() + 1 + i;
        }
    }
    return steps;
}

void Sequencer::shown(std::uint64_t stepNumber, std::int64_t frameIntervalNs) {
    if (client_) {
        client_->shown(stepNumber, frameIntervalNs);
    }
}

void Sequencer::distrustServer() {
    fmt::print(stderr, "haptic link: the server's sand differs from the wall's; it starts again from the wall's\n");
    client_->stop();
    client_ = std::make_unique<haptic_bridge::Client>(*server_, offer_);
    linkChanges_ = 0;
    takeOver();
}

std::optional<haptic_bridge::Report> Sequencer::report() const { return client_ ? client_->report() : std::nullopt; }

haptic_bridge::LinkCounters Sequencer::counters() const {
    return client_ ? client_->counters() : haptic_bridge::LinkCounters{};
}

void Sequencer::stop() {
    if (client_) {
        client_->stop();
    }
}

}  // namespace master
