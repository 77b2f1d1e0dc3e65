// SPDX-License-Identifier: Apache-2.0
#include "master/steps/pointer_hand.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace master {

PointerHand::PointerHand(int stepsPerSecond, const sand::Replica& sand)
    : path_(stepsPerSecond), last_(sand.probe()), liftFirst_(sand.engaged()) {
    path_.restart(last_, false);
}

void PointerHand::add(const lockstep::PointerSample& sample, const sand::Replica& sand) {
    if (sample.meets != 0) {
        const double radius = sand.toolShape().radius;
        const double above = radius * (sample.pressed != 0 ? 1 - depth_ : kHover);
        constexpr std::int32_t kFarthest = sand::kMaxProbe - 1;
        last_ = {sample.x, sample.y, std::min(sample.z + static_cast<std::int32_t>(std::lround(above)), kFarthest)};
    }
    engaged_ = sample.meets != 0 && sample.pressed != 0;
    path_.add({sample.at, last_, engaged_});
}

void PointerHand::take(std::span<const lockstep::PointerReport> reports, const sand::Replica& sand) {
    for (const lockstep::PointerReport& report : reports) {
        depth_ = std::clamp(depth_ + kDepthPerNotch * static_cast<double>(report.wheel), 0.0, kDeepest);
    }
    const std::optional<std::size_t> hand = arbiter_.hand(reports);
    if (!hand) {
        return;
    }
    const auto places = reports[*hand].places();
    if (std::exchange(hand_, hand) != hand && engaged_ && !places.empty()) {
        // Avoids a furrow from the former hand's place to that of the new one.
        engaged_ = false;
        path_.add({places.front().at, last_, false});
    }
    for (const lockstep::PointerSample& sample : places) {
        add(sample, sand);
    }
}

std::int64_t PointerHand::fill(sand::Step& step) { return std::exchange(liftFirst_, false) ? 0 : path_.take(step); }

}  // namespace master
