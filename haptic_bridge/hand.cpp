// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand.hpp"

#include <algorithm>
#include <utility>

#include "haptic_bridge/monotonic.hpp"
#include "sand/force/contact_force.hpp"

namespace haptic_bridge {

Hand::Hand(const sand::Scene& scene, std::unique_ptr<Device> device, HandSettings::Datum datum)
    : model_(scene.force), device_(std::move(device)), mapping_(scene, datum) {
    last_ = mapping_.probe(Pose{}).value_or(sand::ProbePoint{});
}

HandSample Hand::tick(double deviceTime, std::int64_t nowNs, const Surface& surface) {
    const Pose pose = device_->read(deviceTime);
    const auto probe = mapping_.probe(pose);
    last_ = probe.value_or(last_);
    const HandSample sample{nowNs, last_, pose.engaged && probe.has_value()};
    const sand::force::Vec3 place = mapping_.place(last_);
    updateVelocity(deviceTime, place);

    const std::int64_t begin = monotonicNs();
    sand::force::Vec3 force;
    if (sample.engaged) {
        const double age = static_cast<double>(nowNs - surface.timeNs) * 1e-9;
        const auto felt = model_.at(surface.patch, surface.step, surface.tool, place, deviceTime);
        const auto tangential = velocity_ - dot(velocity_, felt.normal) * felt.normal;
        force = sand::force::guarded(felt.push - felt.drag * tangential, age);
        forceCost_.add(monotonicNs() - begin);
    }
    device_->sendForce(force);
    return sample;
}

void Hand::updateVelocity(double deviceTime, sand::force::Vec3 place) {
    const std::size_t oldest = ticks_ < kWindow ? 0 : ticks_ % kWindow;
    const auto [time, from] = places_[oldest];
    const double span = deviceTime - time;
    velocity_ = ticks_ > 0 && span > 0 ? (1 / (60 * span)) * (place - from) : sand::force::Vec3{};
    places_[ticks_ % kWindow] = {deviceTime, place};
    ++ticks_;
}

}  // namespace haptic_bridge
