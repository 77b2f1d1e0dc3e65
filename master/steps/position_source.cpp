// SPDX-License-Identifier: Apache-2.0
#include "master/steps/position_source.hpp"

#include <cmath>

#include "scene/model/scene.hpp"

namespace master {

using haptic_bridge::Trouble;

PositionSource::PositionSource(const scene::Scene& scene, haptic_bridge::HandSettings::Datum datum)
    : Hand(scene.rules.stepsPerSecond), mapping_(scene, datum, sand::Heights::atFirstUse) {}

void PositionSource::begin(const sand::Replica& sand) {
    Hand::begin(sand);
    check_.emplace(kFarthest, counts_);
}

void PositionSource::add(const std::vector<haptic_bridge::TimedPosition>& positions, std::int64_t nowNs) {
    if (positions.empty()) {
        if (static_cast<double>(nowNs - heardNs_) * 1e-9 > kPatience) {
            Hand::add({nowNs, last().probe, false});
            heardNs_ = nowNs;
        }
        return;
    }
    heardNs_ = nowNs;
    for (const haptic_bridge::TimedPosition& timed : positions) {
        const haptic_bridge::Position& position = timed.position;
        // Checks only x and y. Heights count in tool radii, and a hand may fall by many radii between two positions.
        const bool good = check_->accept(static_cast<double>(position.timeNs) * 1e-9, {position.x, position.y, 0});
        const auto probe = good ? mapping_.probe({position.x, position.y, position.z}) : std::nullopt;
        if (!probe && !std::isfinite(position.z)) {
            counts_.count(Trouble::noNumber);
        }
        Hand::add({timed.receivedNs, probe.value_or(last().probe), probe.has_value() && position.engaged});
    }
}

std::vector<std::string> PositionSource::troubles(std::uint64_t floods, std::int64_t nowNs) {
    for (; floods_ < floods; ++floods_) {
        counts_.count(Trouble::flood);
    }
    return reporter_.lines(counts_, static_cast<double>(nowNs) * 1e-9);
}

}  // namespace master
