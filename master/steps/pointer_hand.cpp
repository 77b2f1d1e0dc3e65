// SPDX-License-Identifier: Apache-2.0
#include "master/steps/pointer_hand.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace master {
namespace {

/// Returns the height of a tool that is `above` the surface, within what a step can hold [probe unit].
std::int32_t raised(std::int32_t surface, double above) {
    return static_cast<std::int32_t>(
        std::clamp<double>(surface + std::round(above), -sand::kMaxProbe, sand::kMaxProbe - 1));
}

}  // namespace

PointerHand::PointerHand(int stepsPerSecond, const sand::Replica& sand)
    : path_(stepsPerSecond), last_(sand.probe()), radius_(sand.tool().radius), liftFirst_(sand.engaged()) {
    path_.restart(last_, false);
}

void PointerHand::add(const lockstep::PointerSample& sample, const sand::Replica& sand) {
    radius_ = sand.tool().radius;
    surface_.reset();
    if (sample.meets != 0) {
        surface_ = sample.z;
        last_ = {sample.x, sample.y, raised(sample.z, radius_ * (sample.pressed != 0 ? 1 - depth_ : kHover))};
    }
    engaged_ = sample.meets != 0 && sample.pressed != 0;
    lastNs_ = sample.at;
    path_.add({sample.at, last_, engaged_});
}

/// Puts a tool that hovers at rest to the height for its new size.
void PointerHand::hoverAt(const sand::Replica& sand) {
    radius_ = sand.tool().radius;
    last_.z = raised(*surface_, kHover * radius_);
    path_.add({lastNs_, last_, false});
    resized_ = true;
}

void PointerHand::lift(std::int64_t at) {
    engaged_ = false;
    path_.add({at, last_, false});
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
    const std::optional<std::size_t> former = std::exchange(hand_, hand);
    if (former != hand && engaged_) {
        // Avoids a furrow from the former hand's place to that of the new one, which may rest for a while.
        const auto ended = reports[*former].places();
        lift(!places.empty() ? places.front().at : !ended.empty() ? ended.back().at : lastNs_);
    }
    for (const lockstep::PointerSample& sample : places) {
        add(sample, sand);
    }
    if (surface_ && !engaged_ && sand.tool().radius != radius_) {
        hoverAt(sand);
    }
}

std::int64_t PointerHand::fill(sand::Step& step) {
    if (std::exchange(liftFirst_, false)) {
        return 0;
    }
    const std::int64_t readNs = path_.take(step);
    return std::exchange(resized_, false) ? 0 : readNs;
}

}  // namespace master
