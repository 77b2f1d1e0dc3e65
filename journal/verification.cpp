// SPDX-License-Identifier: Apache-2.0
#include "journal/verification.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/input_error.hpp"

namespace journal {

struct Verification::Visitor {
    Verification& to;
    const AfterStep& afterStep;

    void operator()(const JournalFrame& frame) const {
        Counts& counts = to.counts_;
        counts.firstFrame = counts.firstFrame == 0 ? frame.frame : counts.firstFrame;
        counts.lastFrame = std::max(counts.lastFrame, frame.frame);
        counts.end.reset();
        if (!frame.doubted) {
            const std::uint64_t before = to.replica_.stepNumber();
            to.compare({frame.steps.empty() ? before : frame.steps.front().number - 1, frame.hashBefore});
        }
        for (const sand::Step& step : frame.steps) {
            apply(step);
        }
    }
    void operator()(const JournalEnd& end) const {
        to.counts_.end = end;
        to.compare(end);
    }
    void operator()(const JournalResumed& resumed) const {
        ++to.counts_.resumes;
        to.counts_.cutBytes += resumed.cutBytes;
        to.counts_.end.reset();
        to.compare(resumed.sand);
    }
    void operator()(const JournalTicks&) const { ++to.counts_.ticks; }
    void operator()(const scene::Material&) const {}
    void operator()(const JournalContinued&) const {}
    void operator()(const JournalDoubt& doubt) const {
        ++to.counts_.doubts;
        // Later steps of the majority's sand are not in the journal, so only this hash can be compared.
        const bool differs = doubt.sand.step == to.replica_.stepNumber() && doubt.sand.hash != to.replica_.stateHash();
        to.counts_.outvoted += differs ? 1 : 0;
    }
    void operator()(const JournalChecked& checked) const { to.compare(checked.sand); }
    void operator()(const JournalForce&) const {}

    void apply(const sand::Step& step) const {
        sand::Replica& replica = to.replica_;
        if (step.number != replica.stepNumber() + 1) {
            throw base::InputError(fmt::format("{}: step {} follows step {}; a part of the session is missing",
                                               to.name_, step.number, replica.stepNumber()));
        }
        to.counts_.lastEpoch = std::max(to.counts_.lastEpoch, step.epoch);
        replica.apply(step);
        if (!replica.leftOut().empty() && to.counts_.leftOut++ == 0) {
            to.counts_.firstLeftOut = fmt::format("step {}: {}", step.number, replica.leftOut());
        }
        if (afterStep) {
            afterStep(replica);
        }
    }
};

void Verification::take(const JournalRecord& record, const AfterStep& afterStep) {
    ++counts_.records;
    std::visit(Visitor{*this, afterStep}, record);
}

void Verification::compare(const JournalEnd& recorded) {
    ++counts_.hashes;
    if (recorded.step == replica_.stepNumber() && recorded.hash == replica_.stateHash()) {
        return;
    }
    if (counts_.differing++ == 0) {
        counts_.firstDifference = Difference{recorded, replica_.stateHash()};
    }
}

}  // namespace journal
