// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/device_hand.hpp"

#include "haptic_bridge/loop/felt_sand.hpp"
#include "host/clock.hpp"

namespace haptic_bridge {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;  // [ns]

}  // namespace

ChannelHand::ChannelHand(const HapticTick& hand, HandChannel& channel, int stepsPerSecond)
    : ChannelHand(hand, channel, stepsPerSecond, host::monotonicNs) {}

void ChannelHand::begin(const sand::Replica& replica) {
    DeviceHand::begin(replica);
    publish(replica, false);
    ++channel_.sitting;
    channel_.moving = true;
}

void ChannelHand::end() {
    channel_.moving = false;
    DeviceHand::end();
}

void ChannelHand::drain() {
    channel_.samples.consume_all([this](const HandSample& sample) { add(sample); });
}

void ChannelHand::collect() {
    if (const std::int64_t now = now_(); last().engaged && !waits() && now - last().readNs > kPatienceNs) {
        add({.readNs = now, .probe = last().probe, .read = false});
    }
}

void ChannelHand::publish(const sand::Replica& replica, bool edited) {
    edits_ += edited ? 1 : 0;
    // The hand feels sand in which its oldest waiting movement is missing. The guards see how old that is.
    madeNs_ = now_();
    stepNs_ = std::min(madeNs_, engagedSinceNs().value_or(madeNs_));
    copy(replica);
}

void ChannelHand::refresh(const sand::Replica& replica) {
    if (now_() - copiedNs_ >= kRefreshNs) {
        copy(replica);
    }
}

/// The patch is around the hand and not around the tool. Before a link's first step the tool is at a place where no
/// hand has been. Later the hand may be ahead of its tool.
void ChannelHand::copy(const sand::Replica& replica) {
    FeltSand& next = channel_.surface.next();
    takeSurface(replica, hand_.probe(), next);
    next.edits = edits_;
    next.timeNs = copiedNs_ = now_();
    next.stepNs = stepNs_;
    next.madeNs = madeNs_;
    next.held = held();
    channel_.surface.publish();
}

void VirtualHand::begin(const sand::Replica& replica) {
    DeviceHand::begin(replica);
    // In real time the force loop reads a hand that rests. In the fast pace no thread does, so it is read here.
    const std::uint64_t millisecond = steps_ * 1000 / stepsPerSecond_;
    hand_.rest(static_cast<double>(millisecond) * HapticTick::kTick);
    publish(replica, false);
    channel_.beginSitting(hand_);
}

void VirtualHand::collect() {
    const std::uint64_t first = steps_ * 1000 / stepsPerSecond_ + 1, last = (steps_ + 1) * 1000 / stepsPerSecond_;
    ++steps_;
    for (std::uint64_t millisecond = first; millisecond <= last; ++millisecond) {
        // The sand was last computed one step ago; under a virtual clock it is never stale.
        const auto now = static_cast<std::int64_t>(millisecond) * kMillisecond;
        surface_.timeNs = now;
        add(hand_.tick(static_cast<double>(millisecond) * HapticTick::kTick, now, surface_));
        channel_.keepTick();
    }
}

void VirtualHand::publish(const sand::Replica& replica, bool edited) {
    takeSurface(replica, hand_.probe(), surface_);
    surface_.edits += edited ? 1 : 0;
    surface_.stepNs = surface_.madeNs = static_cast<std::int64_t>(steps_ * 1000 / stepsPerSecond_) * kMillisecond;
    surface_.held = held();
}

}  // namespace haptic_bridge
