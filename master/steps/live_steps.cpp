// SPDX-License-Identifier: Apache-2.0
#include "master/steps/live_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "host/clock.hpp"
#include "host/event.hpp"
#include "host/print_line.hpp"

namespace master {

using haptic_bridge::Audited;
using haptic_bridge::Link;

namespace {

/// Adds up the work of the next steps of a replica.
class FrameWork {
public:
    explicit FrameWork(const sand::Replica& replica)
        : probe_(replica.probe()),
          engaged_(replica.engaged()),
          hasCoarsePhase_(replica.rules().sweepPlan().hasCoarsePhase()),
          length_(replica.rules().substepLength()) {}
    void add(const sand::Step& step) {
        const bool moves = step.engaged != engaged_ || (step.engaged && (step.heading || !step.path.empty()));
        last_ = {step.sweeps, sand::substepsOf(step, probe_, engaged_, length_), moves && hasCoarsePhase_ ? 1 : 0};
        all_ += last_;
        probe_ = step.path.empty() ? probe_ : step.path.back();
        engaged_ = step.engaged;
    }
    [[nodiscard]] const sand::StepWork& all() const { return all_; }
    /// Returns the work of another step like the last one, without its sub-steps.
    [[nodiscard]] sand::StepWork another() const { return {last_.sweeps, 0, last_.phases}; }

private:
    sand::StepWork all_, last_;
    sand::ProbePoint probe_;
    bool engaged_, hasCoarsePhase_;
    std::int32_t length_;  // of a sub-step [probe unit]
};

constexpr const char* kOtherSand = "the hand felt other sand than the wall has shown";

}  // namespace

LiveSteps::LiveSteps(std::optional<haptic_bridge::Address> server, const scene::Scene& scene, Edits& edits,
                     haptic_bridge::Pace pace, std::uint32_t epoch, haptic_bridge::LinkSecurity security,
                     haptic_bridge::LinkClock clock, AtRest atRest)
    : now_(clock ? std::move(clock) : host::monotonicNs),
      link_(std::move(server), {scene.rules.digest(), scene.name, scene.rules.stepLimits()}, std::move(security), now_,
            pace == haptic_bridge::Pace::fast ? scene.rules.stepsPerSecond : 0),
      own_(scene, pace, atRest, link_.hasServer()),
      edits_(edits),
      budget_(pace, 1'000'000'000 / scene.rules.stepsPerSecond),
      pace_(pace),
      source_(link_.hasServer() ? Source::starting : Source::own),
      epoch_(epoch),
      waitingSinceNs_(now_()) {
    if (link_.hasServer()) {
        link_.connect();
    } else {
        takeOver();
    }
}

double LiveSteps::secondsSince(std::int64_t then) const { return static_cast<double>(now_() - then) * 1e-9; }

void LiveSteps::takeOver(const std::string& reason, const std::string& why) {
    if (!why.empty()) {
        host::printLine("haptic link: {}; the wall continues without a hand", why);
    }
    source_ = Source::own;
    givenState_.drop();
    ++epoch_;
    if (!reason.empty()) {
        host::emitEvent("without_hand", {{"reason", reason}, {"epoch", epoch_}});
    }
    own_.begin(now_());
}

void LiveSteps::grant(const sand::Replica& replica, std::uint64_t stateHash) {
    ++epoch_;
    link_.client()->grant(epoch_, replica.stepNumber(), stateHash, recent_);
    givenState_.drop();
    grantWait_ = kGrantWait;
    source_ = Source::granting;
    waitingSinceNs_ = now_();
}

void LiveSteps::giveState(const sand::Replica& replica) {
    waitingSinceNs_ = now_();
    if (std::optional<base::Bytes> state = givenState_.next(replica)) {
        grantWait_ = kGrantWait + static_cast<double>(state->size()) / kLeastStateRate;
        link_.client()->giveState(std::move(*state));
    }
}

void LiveSteps::followLink(const sand::Replica& replica, std::uint64_t stateHash) {
    if (link_.client() == nullptr && link_.hasServer() && secondsSince(waitingSinceNs_) > kRetryWait) {
        link_.connect();
    }
    if (link_.client() == nullptr) {
        return;
    }
    const haptic_bridge::LinkStatus status = link_.follow(epoch_);
    const Link link = status.link;
    if (status.loaded > loadedMost_) {
        loadedMost_ = status.loaded;
        progressNs_ = now_();
    }
    if (link == Link::loading) {
        progressNs_ = progressNs_ == 0 ? now_() : progressNs_;
        waitingSinceNs_ = now_();  // it has time to connect again afterwards
    }
    own_.followPositions(*link_.client(), link, replica, now_());
    if (link == Link::linked) {
        source_ = Source::server;
        link_.forgetRefusal();
        serverUnhealed_ = false;  // the server has begun with the wall's sand
    } else if (link == Link::streaming) {
        if (source_ != Source::own) {
            takeOver();
        }
    } else if (link == Link::offered) {
        grant(replica, stateHash);
    } else if (link_.client()->needsState()) {
        giveState(replica);
    } else {
        waitForLink(link);
    }
}

void LiveSteps::waitForLink(Link link) {
    const std::string server = link_.address();
    if (source_ == Source::granting && link == Link::granting) {
        if (secondsSince(waitingSinceNs_) > grantWait_) {
            // For kRetryWait, because each try stops the sand.
            link_.leave(fmt::format("it does not begin within {:.0f} s", grantWait_));
            waitingSinceNs_ = now_();
            takeOver("server_does_not_begin", fmt::format("{} does not begin", server));
        }
    } else if (source_ == Source::starting) {
        if (link == Link::refused) {
            takeOver("refused", "refused");
        } else if (progressNs_ != 0 && secondsSince(progressNs_) > kLoadingWait) {
            takeOver("no_server", fmt::format("{} gets no further with its scene", server));
        } else if (secondsSince(waitingSinceNs_) > kStartWait) {
            takeOver("no_server", fmt::format("no answer from {} for {:.0f} s", server, kStartWait));
        }
    } else if (source_ != Source::own) {
        noteLastReport();
        takeOver("lost", "lost");
    }
}

/// Judges the last report of a link that the server has ended.
void LiveSteps::noteLastReport() {
    const std::uint64_t link = counters().links;
    const auto last = link_.client()->report();
    if (source_ == Source::server && link != linksNoted_ && last && last->audited == Audited::differed) {
        memoryChanged_ = serverUnhealed_ = true;
    }
    linksNoted_ = link;
}

ArrivedSteps LiveSteps::next(const sand::Replica& replica, std::uint64_t stateHash, std::size_t most) {
    if (link_.hasServer()) {
        recent_.reached(replica.stepNumber(), stateHash);
    }
    ArrivedSteps steps = stepsDue(replica, stateHash, most);
    edits_.moveInto(steps);
    if (const sand::Edit* edit = linked() ? edits_.nextToAsk(epoch_) : nullptr) {
        link_.client()->request(*edit);
    }
    for (const ArrivedStep& timed : steps) {
        if (link_.hasServer()) {
            recent_.add(timed.step);
            if (linked()) {
                link_.countStep();
                recent_.reached(timed.step.number, timed.serverHash);  // proveServer() compares this hash later
            }
        }
    }
    if (link_.client() != nullptr && (linked() || streaming())) {
        link_.startDrills();
    }
    return steps;
}

ArrivedSteps LiveSteps::stepsDue(const sand::Replica& replica, std::uint64_t stateHash, std::size_t most) {
    const bool fromServer = linked();
    if (fromServer) {
        ArrivedSteps steps = drain(replica, most);
        if (!steps.empty()) {
            return steps;
        }
    }
    followLink(replica, stateHash);
    if (fromServer && source_ == Source::own && link_.client() != nullptr) {
        // Steps that arrived between the first look and the loss of the link count, too.
        ArrivedSteps steps = drain(replica, most);
        if (!steps.empty()) {
            source_ = Source::server;
            --epoch_;
            return steps;
        }
    }
    return source_ == Source::own ? ownSteps(replica, most) : ArrivedSteps();
}

ArrivedSteps LiveSteps::drain(const sand::Replica& replica, std::size_t most) {
    ArrivedSteps steps;
    FrameWork taken(replica);
    while (steps.size() < most) {
        std::vector<haptic_bridge::TimedStep> next = link_.client()->drain(1);
        if (next.empty()) {
            break;
        }
        haptic_bridge::TimedStep& sent = next.front();
        taken.add(sent.step);
        steps.push_back({std::move(sent.step), sent.serverTimeNs, sent.serverHash, sent.receivedNs});
        // Another one must fit, because a step that has been taken cannot be put back.
        if (!budget_.fits(taken.all(), taken.another(), replica.tool())) {
            break;
        }
    }
    return steps;
}

ArrivedSteps LiveSteps::ownSteps(const sand::Replica& replica, std::size_t most) {
    // A slow wall leaves out hovering steps that are too many, because to catch up would only delay it further.
    const std::size_t due = std::min(own_.due(now_(), replica, !edits_.waiting().empty()), most);
    ArrivedSteps steps;
    FrameWork taken(replica);
    // What is owed after an edit, or while sweeps are owed, is known only when the step has been applied.
    for (bool more = true; more && steps.size() < due;) {
        ArrivedStep& next = steps.emplace_back();
        next.step.epoch = epoch_;
        next.step.number = replica.stepNumber() + steps.size();
        if (budget_.holdsHand(replica)) {
            next.step.engaged = replica.engaged();
        } else {
            own_.fill(next, budget_.substeps(replica), now_());
        }
        next.step.edit = edits_.next();
        next.step.sweeps = budget_.sweepsOf(next.step, replica);
        taken.add(next.step);
        // With a coarse phase the sweeps of the next step depend on whether it moves the tool, as the replica will know
        // it.
        const bool known = !replica.rules().sweepPlan().hasCoarsePhase() ||
                           (next.step.engaged == replica.engaged() && !next.step.heading);
        more = known && !next.step.edit.any() && !replica.owed().any() &&
               next.step.sweeps == replica.mostSweeps(next.step) &&
               budget_.fits(taken.all(), taken.another(), replica.tool());
    }
    return steps;
}

void LiveSteps::shown(const haptic_bridge::Shown& frame) {
    budget_.shown(frame.cost, frame.stepNumber);
    if (link_.client() != nullptr) {
        link_.client()->shown(frame);
    }
}

const char* LiveSteps::hand() const {
    return own_.hasPointer() ? "hand points"
           : linked()        ? "hand linked"
           : streaming()     ? "hand streams"
           : starting()      ? "waiting for a hand"
                             : "no hand";
}

bool LiveSteps::proveServer(const ArrivedSteps& steps, std::uint64_t stateHash) {
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
    link_.leave();
    recent_ = {};  // it holds hashes of this server
    serverUnhealed_ = true;
    link_.connect();
    takeOver("other_sand", "the server's sand differs from the wall's, it must start again from the wall's");
}

void LiveSteps::refused(const ArrivedSteps& steps, const std::string& why) {
    if (!linked() || steps.empty() || steps.back().step.epoch != epoch_) {
        return;
    }
    link_.leave(why);
    waitingSinceNs_ = now_();  // for kRetryWait, because a server that has sent such a step will do so again
    takeOver("step_against_rules", fmt::format("{} has sent a step that is left out: {}", link_.address(), why));
}

void LiveSteps::stop() {
    if (haptic_bridge::Client* client = link_.client(); client != nullptr) {
        client->stop();
        const auto last = client->report();
        if (linked() && last && last->audited != Audited::no) {
            serverAtEnd_ = last->audited == Audited::agreed;
        }
    }
    if (serverAtEnd_ == false) {
        serverUnhealed_ = true;
        host::printLine("haptic link: the server's memory had changed at the end of the session; {}", kOtherSand);
    }
    link_.printTicksLeftOut();
}

}  // namespace master
