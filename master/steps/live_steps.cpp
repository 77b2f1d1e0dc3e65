// SPDX-License-Identifier: Apache-2.0
#include "master/steps/live_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

#include "host/clock.hpp"
#include "host/event.hpp"
#include "host/print_line.hpp"
#include "lockstep/cluster.hpp"
#include "scene/scene.hpp"

namespace master {

using haptic_bridge::Audited;
using haptic_bridge::Link;
using haptic_bridge::TimedStep;

namespace {

constexpr const char* kOtherSand = "the hand felt other sand than the wall has shown";

/// Returns the name of a state in the event `link`.
const char* nameOf(Link link) {
    switch (link) {
        case Link::connecting:
            return "connecting";
        case Link::refused:
            return "refused";
        case Link::offered:
            return "offered";
        case Link::granting:
            return "granting";
        case Link::linked:
            return "linked";
        case Link::streaming:
            return "streaming";
        case Link::lost:
            return "lost";
        case Link::stopped:
            return "stopped";
    }
    return "";
}

}  // namespace

LiveSteps::LiveSteps(std::optional<haptic_bridge::Address> server, const scene::Scene& scene, Pace pace,
                     std::uint32_t epoch, haptic_bridge::LinkSecurity security, haptic_bridge::LinkClock clock)
    : server_(std::move(server)),
      offer_{scene.rules.digest(), scene.name},
      security_(std::move(security)),
      now_(clock ? std::move(clock) : host::monotonicNs),
      stepsPerSecond_(scene.rules.stepsPerSecond),
      pace_(pace),
      source_(server_ ? Source::starting : Source::own),
      epoch_(epoch),
      waitingSinceNs_(now_()),
      positions_(scene),
      tickBudget_(pace == Pace::fast ? scene.rules.stepsPerSecond : 0, now_()) {
    if (server_) {
        connect();
    } else {
        takeOver();
    }
}

void LiveSteps::connect() {
    client_ = std::make_unique<haptic_bridge::Client>(*server_, offer_, security_, now_);
    client_->shareForce(share_);
}

double LiveSteps::secondsSince(std::int64_t then) const { return static_cast<double>(now_() - then) * 1e-9; }

void LiveSteps::takeOver(const std::string& reason, const std::string& why) {
    if (!why.empty()) {
        host::printLine("haptic link: {}; the wall continues without a hand", why);
    }
    source_ = Source::own;
    ++epoch_;
    if (!reason.empty()) {
        host::emitEvent("without_hand", {{"reason", reason}, {"epoch", epoch_}});
    }
    ownStepsOwed_ = 0;
    lastOwnNs_ = now_();
}

void LiveSteps::grant(const sand::Replica& terrain, std::uint64_t stateHash) {
    ++epoch_;
    client_->grant(epoch_, terrain.stepNumber(), stateHash, terrain.encodeState(), recent_);
    source_ = Source::granting;
    waitingSinceNs_ = now_();
}

void LiveSteps::sayLink(const haptic_bridge::LinkStatus& status) {
    if (status.changes != linkChanges_) {
        linkChanges_ = status.changes;
        host::emitEvent("link", {{"state", nameOf(status.link)}, {"epoch", epoch_}, {"server", server_->text()}});
        if (!status.message.empty()) {
            host::printLine("haptic link: {}", status.message);
        }
    }
}

void LiveSteps::followLink(const sand::Replica& terrain, std::uint64_t stateHash) {
    if (!client_ && server_ && secondsSince(waitingSinceNs_) > kRetryWait) {
        connect();
    }
    if (!client_) {
        return;
    }
    const haptic_bridge::LinkStatus status = client_->link();
    sayLink(status);
    followPositions(status, terrain);
    if (status.link == Link::linked) {
        source_ = Source::server;
        earlierFailure_.clear();
        serverUnhealed_ = false;  // the server has begun with the wall's sand
    } else if (status.link == Link::streaming) {
        if (source_ != Source::own) {
            takeOver();
        }
    } else if (status.link == Link::offered) {
        grant(terrain, stateHash);
    } else if (source_ == Source::granting && status.link == Link::granting) {
        if (secondsSince(waitingSinceNs_) > kGrantWait) {
            leaveServer();  // for kRetryWait, because each try stops the sand
            waitingSinceNs_ = now_();
            earlierFailure_ = fmt::format("it does not begin within {:.0f} s", kGrantWait);
            takeOver("server_does_not_begin", fmt::format("{} does not begin", server_->text()));
        }
    } else if (source_ == Source::starting) {
        if (status.link == Link::refused) {
            takeOver("refused", "refused");
        } else if (secondsSince(waitingSinceNs_) > kStartWait) {
            takeOver("no_server", fmt::format("no answer from {} for {:.0f} s", server_->text(), kStartWait));
        }
    } else if (source_ != Source::own) {
        noteLastReport();
        takeOver("lost", "lost");
    }
}

/// Judges the last report of a link that the server has ended.
void LiveSteps::noteLastReport() {
    const std::uint64_t link = counters().links;
    const auto last = client_->report();
    if (source_ == Source::server && link != linksNoted_ && last && last->audited == Audited::differed) {
        memoryChanged_ = serverUnhealed_ = true;
    }
    linksNoted_ = link;
}

void LiveSteps::followPositions(const haptic_bridge::LinkStatus& status, const sand::Replica& terrain) {
    if (status.link != Link::streaming) {
        positions_.end();
        return;
    }
    if (!positions_.streaming()) {
        positions_.begin(terrain);
    }
    positions_.add(client_->drainPositions(), now_());
    for (const std::string& line : positions_.troubles(client_->floods(), now_())) {
        host::printLine("{}", line);
    }
}

std::size_t LiveSteps::ownStepsDue() {
    if (pace_ == Pace::fast) {
        return 1;
    }
    const std::int64_t now = now_();
    ownStepsOwed_ += static_cast<double>(now - lastOwnNs_) * 1e-9 * stepsPerSecond_;
    lastOwnNs_ = now;
    // A pointer is read once per frame. Rounding gives each frame its step, although frames are never quite punctual.
    const double due = std::floor(ownStepsOwed_ + (pointer_ ? 0.5 : 0));
    ownStepsOwed_ -= due;
    return static_cast<std::size_t>(due);
}

void LiveSteps::shareForce(double share) {
    share_ = {share, true};
    if (client_) {
        client_->shareForce(share_);
    }
}

void LiveSteps::passEdits(const std::vector<TimedStep>& steps) {
    for (const TimedStep& timed : steps) {
        if (timed.step.edit.any() && !edits_.empty() && timed.step.edit == edits_.front()) {
            edits_.pop_front();
            toldEpoch_ = 0;
        }
    }
    // Asks for one edit at a time, because the server keeps only one for its next step. If a link was lost with an
    // edit, asks for it again in the next epoch.
    if (source_ == Source::server && !edits_.empty() && toldEpoch_ != epoch_) {
        client_->request(edits_.front());
        toldEpoch_ = epoch_;
    }
}

std::vector<TimedStep> LiveSteps::next(const sand::Replica& terrain, std::uint64_t stateHash, std::size_t most) {
    if (server_) {
        recent_.reached(terrain.stepNumber(), stateHash);
    }
    std::vector<TimedStep> steps = stepsDue(terrain, stateHash, most);
    passEdits(steps);
    for (const TimedStep& timed : steps) {
        if (server_) {
            recent_.add(timed.step);
            if (source_ == Source::server) {
                tickBudget_.step();
                recent_.reached(timed.step.number, timed.serverHash);  // proveServer() compares this hash later
            }
        }
    }
    startDrills();
    return steps;
}

std::vector<TimedStep> LiveSteps::stepsDue(const sand::Replica& terrain, std::uint64_t stateHash, std::size_t most) {
    std::vector<TimedStep> steps;
    if (client_ && source_ == Source::server) {
        steps = client_->drain(most);
    }
    if (!steps.empty()) {
        return steps;
    }
    const bool fromServer = source_ == Source::server;
    followLink(terrain, stateHash);
    if (fromServer && source_ == Source::own && client_) {
        // Steps that arrived between the first look and the loss of the link count, too.
        steps = client_->drain(most);
        if (!steps.empty()) {
            source_ = Source::server;
            --epoch_;
            return steps;
        }
    }
    if (source_ == Source::own) {
        // A slow wall leaves out hovering steps that are too many, because to catch up would only delay it further.
        const std::size_t due = std::min(ownStepsDue(), most);
        for (std::size_t i = 0; i < due; ++i) {
            TimedStep& own = steps.emplace_back();
            own.step.epoch = epoch_;
            own.step.number = terrain.stepNumber() + 1 + i;
            fill(own);
            own.step.edit = i < edits_.size() ? edits_[i] : sand::Edit();
        }
    }
    return steps;
}

void LiveSteps::fill(TimedStep& own) {
    if (!pointer_) {
        positions_.fill(own.step);
        return;
    }
    own.serverTimeNs = pointer_->fill(own.step);
    own.receivedNs = pointedNs_;
}

void LiveSteps::pointed(std::span<const lockstep::PointerReport> reports, const sand::Replica& sand,
                        std::int64_t receivedNs) {
    if (!pointer_) {
        pointer_.emplace(stepsPerSecond_, sand);
    }
    pointer_->take(reports, sand);
    pointedNs_ = receivedNs;
}

void LiveSteps::shown(std::uint64_t stepNumber, std::int64_t frameIntervalNs, haptic_bridge::Held held) {
    if (client_) {
        client_->shown(stepNumber, frameIntervalNs, held);
    }
}

const char* LiveSteps::hand() const {
    return pointer_      ? "hand points"
           : linked()    ? "hand linked"
           : streaming() ? "hand streams"
           : starting()  ? "waiting for a hand"
                         : "no hand";
}

std::vector<base::Bytes> LiveSteps::ticks() {
    std::vector<base::Bytes> pieces = std::exchange(ticks_, {});
    if (client_) {
        for (base::Bytes& piece : client_->drainTicks()) {
            if (tickBudget_.take(piece.size(), now_())) {
                pieces.push_back(std::move(piece));
            } else if (tickBudget_.refused() == 1) {
                host::printLine(
                    "haptic link: {} sends more ticks than a hand can make; the journal leaves out those beyond",
                    server_->text());
            }
        }
    }
    return pieces;
}

void LiveSteps::leaveServer() {
    ticks_ = ticks();
    earlierReport_ = report();
    earlierFailure_ = client_->lastFailure();
    earlierLinks_ = counters();
    ++earlierLinks_.reconnects;
    client_->stop();
    client_.reset();
    linkChanges_ = 0;
}

bool LiveSteps::proveServer(const std::vector<TimedStep>& steps, std::uint64_t stateHash) {
    if (std::exchange(memoryChanged_, false)) {
        host::printLine("haptic link: the server's memory had changed by the end of its link; {}", kOtherSand);
        return false;
    }
    // Meanwhile the link may have been lost. The steps may also be the master's own.
    const bool fromServer = linked() && !steps.empty() && steps.back().step.epoch == epoch_;
    if (!fromServer || steps.back().serverHash == stateHash) {
        return true;
    }
    distrustServer();
    return false;
}

void LiveSteps::distrustServer() {
    leaveServer();
    recent_ = {};  // it holds hashes of this server
    serverUnhealed_ = true;
    connect();
    takeOver("other_sand", "the server's sand differs from the wall's, it must start again from the wall's");
}

void LiveSteps::startDrills() {
    if (!client_ || !(linked() || streaming())) {
        return;
    }
    for (const lockstep::Fault& fault : std::exchange(drills_, {})) {
        const bool silence = fault.kind == lockstep::Fault::Kind::partition;
        client_->drill(silence ? haptic_bridge::LinkDrill::silence : haptic_bridge::LinkDrill::garbage,
                       std::chrono::milliseconds(fault.milliseconds));
    }
}

std::optional<haptic_bridge::Report> LiveSteps::report() const {
    const auto latest = client_ ? client_->report() : std::nullopt;
    return latest ? latest : earlierReport_;
}

std::string LiveSteps::lastRefusal() const {
    const std::string latest = client_ ? client_->lastFailure() : "";
    return latest.empty() ? earlierFailure_ : latest;
}

haptic_bridge::LinkCounters LiveSteps::counters() const {
    haptic_bridge::LinkCounters sum = earlierLinks_;
    if (client_) {
        sum.add(client_->counters());
    }
    return sum;
}

void LiveSteps::stop() {
    if (client_) {
        client_->stop();
        const auto last = client_->report();
        if (linked() && last && last->audited != Audited::no) {
            serverAtEnd_ = last->audited == Audited::agreed;
        }
    }
    if (serverAtEnd_ == false) {
        serverUnhealed_ = true;
        host::printLine("haptic link: the server's memory had changed at the end of the session; {}", kOtherSand);
    }
    if (tickBudget_.refused() > 0) {
        host::printLine("haptic link: the journal has left out {} pieces of ticks", tickBudget_.refused());
    }
}

}  // namespace master
