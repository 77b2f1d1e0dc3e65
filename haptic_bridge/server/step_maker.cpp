// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/step_maker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <utility>

namespace haptic_bridge {
namespace {

/// Runs `decode`. Returns why the bytes of a master cannot be decoded, or an empty text.
template <class Decode>
std::string whyNot(const Decode& decode) {
    try {
        decode();
        return {};
    } catch (const std::bad_alloc&) {
        return "this machine has no memory for it";
    } catch (const std::exception& error) {
        return error.what();
    }
}

}  // namespace

StepMaker::StepMaker(sand::Replica replica, DeviceHand& hand, Output output, Clock clock)
    : hand_(hand),
      output_(std::move(output)),
      replica_(std::move(replica)),
      now_(std::move(clock)),
      clock_(replica_.rules().stepsPerSecond),
      budget_(hand.onHostClock() ? Pace::realtime : Pace::fast, 1'000'000'000 / replica_.rules().stepsPerSecond) {}

bool StepMaker::asGranted() {
    return replica_.stepNumber() == start_.stepNumber && replica_.stateHash() == start_.stateHash;
}

void StepMaker::start(std::uint32_t session, const StartMessage& start) {
    session_ = session;
    start_ = start;
    if (asGranted()) {
        begin();
    } else {
        phase_ = Phase::awaitingState;
        asksForSand_ = false;
        output_.needState(session_, {replica_.stepNumber(), replica_.stateHash()});
    }
}

void StepMaker::state(const base::Bytes& bytes) {
    if (phase_ != Phase::awaitingState) {
        return;
    }
    phase_ = Phase::idle;
    if (const std::string why = whyNot([&] { replica_.decodeState(bytes); }); !why.empty()) {
        output_.unusable(session_, "the state does not fit this scene: " + why);
        return;
    }
    if (!asGranted()) {
        output_.unusable(session_, "the state does not have the announced hash");
        return;
    }
    begin();
}

void StepMaker::catchUp(const CatchUp& steps) {
    if (phase_ != Phase::awaitingState || asksForSand_) {
        return;
    }
    bool fits = true;
    for (const sand::Step& step : steps.steps) {
        fits = fits && step.number == replica_.stepNumber() + 1 && step.number <= start_.stepNumber &&
               step.refusal(replica_.rules().stepLimits()).empty();
        if (fits) {
            replica_.apply(step);
        }
    }
    if (fits && !steps.last) {
        return;
    }
    if (fits && asGranted()) {
        begin();
    } else {
        asksForSand_ = true;
        output_.needState(session_, {});
    }
}

void StepMaker::shown(const Shown& frame, std::int64_t nowNs) {
    if (!running()) {
        return;
    }
    // The master's number is not trusted: shown_ never falls, and never passes the last step that was sent.
    shown_ = std::max(shown_, std::min(frame.stepNumber, replica_.stepNumber()));
    held_ = frame.held;
    hand_.hold(held_);
    clock_.frameShown(nowNs, frame.frameIntervalNs);
    budget_.shown(frame.cost, shown_);
}

void StepMaker::edit(EditRequest request) {
    if (!running()) {
        return;
    }
    if (const auto& sand = request.edit.sand; sand) {
        // Refuses the sand here, because a step that holds it can no longer be refused.
        if (static_cast<std::int64_t>(sand->size()) > replica_.rules().stepLimits().mostSandBytes) {
            output_.unusable(session_, fmt::format("a load of {} bytes of sand; this scene's steps load at most {}",
                                                   sand->size(), replica_.rules().stepLimits().mostSandBytes));
            return;
        }
        if (const std::string why = whyNot([&] { (void)replica_.sandReader()(*sand); }); !why.empty()) {
            output_.unusable(session_, "the sand of a load does not fit this scene: " + why);
            return;
        }
    }
    edit_ = std::move(request.edit);
}

void StepMaker::audit() {
    if (!running()) {
        return;
    }
    const std::uint64_t sent = replica_.stateHash();
    replica_.audit(replica_.hashTiles().tileCount());
    output_.audited(session_, replica_.stateHash() == sent ? Audited::agreed : Audited::differed);
}

void StepMaker::release() {
    phase_ = Phase::idle;
    hand_.end();
}

void StepMaker::begin() {
    phase_ = Phase::running;
    edit_ = {};
    shown_ = start_.stepNumber;
    held_.reset();
    hand_.hold(held_);
    clock_.start(now_());
    hand_.begin(replica_);
    output_.ready(session_);
}

void StepMaker::collect() {
    hand_.drain();
    dropped_ = hand_.dropped();
}

/// Returns the time at which the last sample of the step was read [ns, the host's clock]. Returns 0 if the step has no
/// sample, or if the samples have another clock.
std::int64_t StepMaker::fill(sand::Step& step) {
    const std::int64_t readNs = hand_.fill(step, budget_.substeps(replica_));
    if (sand::isRound(replica_.tool().kind) || step.heading == replica_.heading()) {
        step.heading.reset();  // the heading would not change the sand
    }
    return hand_.onHostClock() ? readNs : 0;
}

Withheld StepMaker::cause() const {
    if (!held_) {
        return Withheld::start;
    }
    return *held_ == Held::disk ? Withheld::disk : *held_ == Held::pause ? Withheld::pause : Withheld::wall;
}

WithheldCounts StepMaker::withheld() const {
    WithheldCounts counts{};
    std::copy(withheld_.begin(), withheld_.end(), counts.begin());
    return counts;
}

void StepMaker::makeStep() {
    if (blocked()) {  // only in real time, because the fast pace waits instead
        ++withheld_[static_cast<std::size_t>(cause())];
        clock_.advance(now_());
        return;
    }
    StepMessage message;
    message.step.epoch = start_.epoch;
    message.step.number = replica_.stepNumber() + 1;
    message.serverTimeNs = now_();
    if (budget_.holdsHand(replica_)) {
        message.step.engaged = replica_.engaged();
        message.serverTimeNs = 0;  // no latency of the hand
    } else if (const std::int64_t readNs = fill(message.step); readNs != 0 || replica_.holdsTool()) {
        message.serverTimeNs = readNs;  // 0 if a press waits for sweeps that are owed
    }
    message.step.edit = std::exchange(edit_, {});
    message.step.sweeps = budget_.sweepsOf(message.step, replica_);
    const bool edited = message.step.edit.any();
    const std::uint64_t edit = message.step.edit.number;
    replica_.apply(message.step);
    message.step.edit.sand.reset();  // perhaps hundreds of MiB, which the master has
    message.stateHash = replica_.stateHash();
    output_.step(session_, encode(std::move(message)), edit);
    hand_.publish(replica_, edited);
    clock_.advance(now_());
}

void StepMaker::refresh() {
    if (running()) {
        hand_.refresh(replica_);
    }
}

}  // namespace haptic_bridge
