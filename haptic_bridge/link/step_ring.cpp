// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/step_ring.hpp"

namespace haptic_bridge {

void StepRing::reached(std::uint64_t stepNumber, std::uint64_t stateHash) {
    if (stepNumber < begin_ || stepNumber > begin_ + entries_.size()) {
        entries_.clear();
        begin_ = stepNumber;
    }
    if (stepNumber == begin_) {
        beginHash_ = stateHash;
    } else {
        entries_[stepNumber - begin_ - 1].hash = stateHash;
    }
}

void StepRing::add(const sand::Step& step) {
    if (step.number != begin_ + entries_.size() + 1 || step.edit.kind == sand::Edit::load) {
        entries_.clear();
        begin_ = step.number;
        beginHash_ = std::nullopt;
    }
    if (step.number != begin_) {
        entries_.push_back({step, std::nullopt});
    }
    if (entries_.size() > kSteps) {
        begin_ = entries_.front().step.number;
        beginHash_ = entries_.front().hash;
        entries_.pop_front();
    }
}

std::optional<std::vector<sand::Step>> StepRing::since(const NeedState& there, std::uint64_t stepNumber) const {
    const std::uint64_t end = begin_ + entries_.size();
    if (there.stepNumber < begin_ || there.stepNumber >= stepNumber || stepNumber > end) {
        return std::nullopt;
    }
    const std::size_t first = there.stepNumber - begin_;
    const std::optional<std::uint64_t> hash = first == 0 ? beginHash_ : entries_[first - 1].hash;
    if (!hash || *hash != there.stateHash) {
        return std::nullopt;
    }
    std::vector<sand::Step> steps;
    for (std::size_t i = first; i < stepNumber - begin_; ++i) {
        steps.push_back(entries_[i].step);
    }
    return steps;
}

}  // namespace haptic_bridge
