// SPDX-License-Identifier: Apache-2.0
#include "master/steps/slow_motion.hpp"

#include <algorithm>

#include "haptic_bridge/hand/path_builder.hpp"

namespace master {

SlowMotion::SlowMotion(int stepsPerSecond) : periodNs_(1'000'000'000 / stepsPerSecond) {}

void SlowMotion::add(std::int64_t passedNs, const ArrivedSteps& steps) {
    passedNs_ += engaged_ ? passedNs : 0;
    for (const ArrivedStep& timed : steps) {
        const std::int64_t readNs = timed.readNs();
        if (readNs == 0) {  // it only pays sweeps, or no hand has made it
            continue;
        }
        if (engaged_ && timed.step.epoch == epoch_) {
            const std::int64_t since = std::max<std::int64_t>(readNs - readNs_, 0);
            // A path holds no more. If more time lies between two of them, samples were dropped. A hand at rest has no
            // path, and nothing of it is lost.
            const std::int64_t most = haptic_bridge::PathBuilder::kMostPeriods * periodNs_;
            takenNs_ += timed.step.path.empty() ? since : std::min(since, most);
        }
        engaged_ = timed.step.engaged;
        readNs_ = readNs;
        epoch_ = timed.step.epoch;
    }
}

void SlowMotion::addRest(std::int64_t passedNs) {
    if (engaged_) {
        passedNs_ += passedNs;
        takenNs_ += passedNs;
        readNs_ += passedNs;
    }
}

std::optional<double> SlowMotion::factor() const {
    if (passedNs_ < kLeastNs) {
        return std::nullopt;
    }
    // The first press takes no time of the hand.
    return static_cast<double>(passedNs_) / static_cast<double>(std::max(takenNs_, periodNs_));
}

}  // namespace master
