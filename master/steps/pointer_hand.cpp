// SPDX-License-Identifier: Apache-2.0
#include "master/steps/pointer_hand.hpp"

#include <algorithm>
#include <utility>

namespace master {
namespace {

/// Returns `surface` raised by `above` [probe unit].
sand::ProbePoint raised(const sand::ProbePoint& surface, double above) {
    return {surface.x, surface.y, sand::probeCoordinate((surface.z + above) / sand::kProbePerCell)};
}

}  // namespace

PointerHand::PointerHand(int stepsPerSecond, const sand::Replica& sand)
    : path_(stepsPerSecond), last_(sand.probe()), radius_(sand.toolShape().radius), liftFirst_(sand.engaged()) {
    path_.restart(last_, false);
}

void PointerHand::add(const lockstep::PointerSample& sample, const sand::Replica& sand) {
    radius_ = sand.toolShape().radius;
    surface_.reset();
    if (sample.meets != 0) {
        surface_ = sample.probe.z;
        last_ = raised(sample.probe, radius_ * (sample.pressed != 0 ? 1 - depth_ : kHover));
    }
    engaged_ = sample.meets != 0 && sample.pressed != 0;
    lastNs_ = sample.readNs;
    path_.add({sample.readNs, last_, engaged_});
}

/// Puts a tool that hovers at rest to the height for its new size.
void PointerHand::hoverAt(const sand::Replica& sand) {
    radius_ = sand.toolShape().radius;
    last_ = raised({last_.x, last_.y, *surface_}, kHover * radius_);
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
        lift(!places.empty() ? places.front().readNs : !ended.empty() ? ended.back().readNs : lastNs_);
    }
    for (const lockstep::PointerSample& sample : places) {
        add(sample, sand);
    }
    if (surface_ && !engaged_ && sand.toolShape().radius != radius_) {
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
