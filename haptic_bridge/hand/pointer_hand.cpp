// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/pointer_hand.hpp"

#include <utility>

namespace haptic_bridge {
namespace {

/// Returns `surface` raised by `above` [probe unit].
sand::ProbePoint raised(const sand::ProbePoint& surface, double above) {
    return {surface.x, surface.y, sand::probeCoordinate((surface.z + above) / sand::kProbePerCell)};
}

}  // namespace

PointerHand::PointerHand(int stepsPerSecond, const sand::Replica& sand)
    : Hand(stepsPerSecond), radius_(sand.tool().radius) {
    Hand::begin(sand);
}

void PointerHand::point(const PointerSample& sample, double depth, const sand::Replica& sand) {
    radius_ = sand.tool().radius;
    surface_.reset();
    if (sample.meets == 0) {
        lift(sample.readNs);
        return;
    }
    const bool pressed = sample.pressed != 0;
    surface_ = sample.probe.z;
    add({sample.readNs, raised(sample.probe, radius_ * (pressed ? 1 - depth : kHover)), pressed});
}

/// Puts a tool that hovers at rest to the height for its new size.
void PointerHand::hoverAt(const sand::Replica& sand) {
    radius_ = sand.tool().radius;
    const HandSample& before = last();
    add({.readNs = before.readNs,
         .probe = raised({before.probe.x, before.probe.y, *surface_}, kHover * radius_),
         .read = false});
}

void PointerHand::lift(std::int64_t readNs) { add({readNs, last().probe, false}); }

void PointerHand::take(std::span<const PointerReport> reports, double depth, const sand::Replica& sand) {
    const std::optional<std::size_t> hand = arbiter_.hand(reports);
    if (!hand) {
        return;
    }
    const auto samples = reports[*hand].taken();
    const std::optional<std::size_t> former = std::exchange(hand_, hand);
    if (former != hand && last().engaged) {
        // Avoids a furrow from the former hand's place to that of the new one, which may rest for a while.
        const auto ended = reports[*former].taken();
        lift(!samples.empty() ? samples.front().readNs : !ended.empty() ? ended.back().readNs : last().readNs);
    }
    for (const PointerSample& sample : samples) {
        point(sample, depth, sand);
    }
    if (surface_ && !last().engaged && sand.tool().radius != radius_) {
        hoverAt(sand);
    }
}

}  // namespace haptic_bridge
