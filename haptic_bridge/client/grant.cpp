// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/client/grant.hpp"

#include <algorithm>
#include <utility>

namespace haptic_bridge {

std::vector<CatchUp> Grant::catchUps(const NeedState& need) {
    std::vector<CatchUp> answer;
    auto steps = handOvers_++ == 0 ? recent_.since(need, start_.stepNumber) : std::nullopt;
    if (!steps) {
        handOvers_ = 2;
        awaitsState_ = true;
        return answer;
    }
    for (std::size_t begin = 0; begin < steps->size(); begin += kMaxCatchUp) {
        const std::size_t end = std::min(begin + kMaxCatchUp, steps->size());
        const auto at = [&](std::size_t i) {
            return std::make_move_iterator(steps->begin() + static_cast<std::ptrdiff_t>(i));
        };
        answer.push_back({end == steps->size(), {at(begin), at(end)}});
    }
    return answer;
}

Grant::Arrival Grant::arrived(sand::Step& step) {
    if (step.epoch != start_.epoch) {
        return Arrival::foreign;
    }
    if (step.number <= lastStep_) {
        return Arrival::stale;
    }
    if (step.number != lastStep_ + 1) {
        return Arrival::afterGap;
    }
    if (step.edit.any()) {
        const auto edit = std::find_if(asked_.begin(), asked_.end(),
                                       [&](const sand::Edit& one) { return one.number == step.edit.number; });
        if (edit == asked_.end() || edit->kind != step.edit.kind) {
            return Arrival::unasked;
        }
        step.edit = std::move(*edit);
        asked_.erase(asked_.begin(), edit + 1);
    }
    lastStep_ = step.number;
    return Arrival::next;
}

void Grant::asked(const sand::Edit& edit) {
    if (asked_.size() == kMostAsked) {
        asked_.pop_front();
    }
    asked_.push_back(edit);
}

Shown Grant::bounded(const Shown& frame) const {
    Shown bounded = frame;
    bounded.stepNumber = std::clamp(frame.stepNumber, start_.stepNumber, lastStep_);
    return bounded;
}

}  // namespace haptic_bridge
