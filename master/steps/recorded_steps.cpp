// SPDX-License-Identifier: Apache-2.0
#include "master/steps/recorded_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace master {

RecordedSteps::RecordedSteps(std::shared_ptr<const journal::Recording> recording, std::uint64_t last)
    : recording_(std::move(recording)), last_(std::min(last, recording_->lastStep())) {}

ArrivedSteps RecordedSteps::next(const sand::Replica& /* sand */, std::uint64_t /* hash */, std::size_t /* most */) {
    ArrivedSteps steps;
    for (const sand::Step& step : recording_->stepsOf(++frame_)) {
        if (step.number <= last_) {
            steps.emplace_back().step = step;
        }
    }
    return steps;
}

void RecordedSteps::reached(sand::Replica& sand) {
    if (strayed_) {
        return;
    }
    const auto recorded = recording_->hashAfter(sand.stepNumber());
    if (recorded && *recorded != sand.stateHash()) {
        line_ = fmt::format(
            "after step {}: the session had {:016x}, now it is {:016x}; the recording is of another version or "
            "damaged, and ends here",
            sand.stepNumber(), *recorded, sand.stateHash());
        strayed_ = true;
    }
}

void RecordedSteps::healed(sand::Replica& sand) {
    strayed_ = false;
    line_.clear();
    reached(sand);
}

std::string RecordedSteps::takeStrayLine() { return std::exchange(line_, {}); }

}  // namespace master
