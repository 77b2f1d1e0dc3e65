// SPDX-License-Identifier: Apache-2.0
#include "master/steps/own_steps.hpp"

#include <cmath>

#include "host/print_line.hpp"
#include "shapes/model/sharpening.hpp"

namespace master {

bool OwnSteps::wouldChange(const sand::Replica& sand, bool edited) {
    // Without a hand, the next step lifts a tool that is still in the sand.
    return edited || !sand.atRest() || (hand().present() ? hand().moves() : sand.engaged());
}

bool OwnSteps::drawnAsResting(const sand::Replica& sand) const {
    const sand::Movement* const movement = sand.surface().movement();
    return movement == nullptr || shapes::Sharpening(stepsPerSecond_, movement->moved.size()).allSharp(*movement);
}

void OwnSteps::followRest(std::int64_t nowNs, bool changes, const sand::Replica& sand) {
    if (changes) {
        movedNs_ = nowNs;
    }
    rests_ = atRest_ == AtRest::makesNone && static_cast<double>(nowNs - movedNs_) * 1e-9 >= kRestAfter &&
             drawnAsResting(sand);
    if (rests_) {
        hand().forgetRest();  // otherwise the path after the rest would begin with samples that are as old
    }
}

std::size_t OwnSteps::due(std::int64_t nowNs, const sand::Replica& sand, bool edited) {
    if (pace_ == haptic_bridge::Pace::fast) {
        return 1;
    }
    const bool rested = rests_;
    followRest(nowNs, wouldChange(sand, edited), sand);
    if (rests_) {
        return 0;
    }
    // The time of a rest does not count for steps. The step that ends it does not wait for its period.
    owed_ = rested ? 1 : owed_ + static_cast<double>(nowNs - lastNs_) * 1e-9 * stepsPerSecond_;
    lastNs_ = nowNs;
    // A pointer is read once per frame. Rounding gives each frame its step, although frames are never quite punctual.
    const double due = std::floor(owed_ + (pointer_ ? 0.5 : 0));
    owed_ -= due;
    return static_cast<std::size_t>(due);
}

void OwnSteps::fill(ArrivedStep& own, const haptic_bridge::SubstepLimit& limit, std::int64_t nowNs) {
    const std::int64_t readNs = hand().fill(own.step, limit);
    // If no sample of the hand waits, the hand is where the tool is. A pointer at rest sends no samples.
    own.handNs = hand().waits() ? readNs : nowNs;
    if (pointer_) {
        own.serverTimeNs = readNs;
        own.receivedNs = pointedNs_;
    }
}

void OwnSteps::followPositions(haptic_bridge::Client& client, haptic_bridge::Link link, const sand::Replica& sand,
                               std::int64_t nowNs) {
    if (link != haptic_bridge::Link::streaming) {
        positions_.end();
        return;
    }
    if (!positions_.streaming()) {
        positions_.begin(sand);
    }
    positions_.add(client.drainPositions(), nowNs);
    for (const std::string& line : positions_.troubles(client.floods(), nowNs)) {
        host::printLine("{}", line);
    }
}

void OwnSteps::pointed(std::span<const haptic_bridge::PointerReport> reports, double depth, const sand::Replica& sand,
                       std::int64_t receivedNs) {
    if (!pointer_) {
        pointer_.emplace(stepsPerSecond_, sand);
    }
    pointer_->take(reports, depth, sand);
    pointedNs_ = receivedNs;
}

}  // namespace master
