// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "haptic_bridge/loop/guards/guards.hpp"
#include "tests/haptic_bridge/loop/push_check.hpp"

namespace test {

/// Says for each tick what its push may be: docs/forces.md a second time, from the readings that the guards get. It
/// takes only the numbers of ForceLimits from the guards.
class PushOracle {
public:
    using Vec3 = sand::force::Vec3;
    using Reading = haptic_bridge::Guards::Reading;

    explicit PushOracle(const haptic_bridge::ForceLimits& limits) : limits_(limits) {}

    /// Forgets all ticks, as at the start of a link.
    void forget() { *this = PushOracle(limits_); }
    /// Returns what is known about the push of the next tick.
    [[nodiscard]] PushCheck::Asked next(const Reading& reading) {
        const bool first = !begun_;
        const double span = first ? reading.time - reading.time : reading.time - time_;
        PushCheck::Asked asked;
        asked.time = reading.time;
        const bool late = !reading.present && reading.silent && mayBeLate(reading.time);
        asked.fault = hasFault(reading, span, first, late);
        asked.late = late && !asked.fault;
        if (asked.late) {
            const double before = silence_;
            silence_ += span;
            asked.left = silence_ < kLate - kRounding ? (kLate - silence_) / (kLate - before) : 0;
        } else {
            silence_ = 0;
        }
        heard_ = reading.present || asked.late;
        begun_ = true;
        time_ = reading.time;
        place_ = late ? place_ : reading.place;
        const double passed = span > 0 ? span : 0;
        asked.share = shareAfter(passed, reading.share, first) * movingAfter(passed, reading.stepAge);
        const double soft = softnessAfter(passed, reading.stepAge);
        if (!asked.fault && !late) {
            const double limited = reading.engaged ? norm(limitedAt(reading, soft)) : 0;
            asked.contact = limited > 0;
            asked.edited = reading.edited;
            asked.engaged = reading.engaged;
            asked.place = reading.place;
            asked.whole = asked.share * std::min(limited, limits_.maxForce);
        }
        return asked;
    }
    /// Returns whether a tick at `time` [s] without a reading may still get a part of the last force: within 10 ms of
    /// silence.
    [[nodiscard]] bool mayBeLate(double time) const { return heard_ && silence_ + (time - time_) <= kLate + kRounding; }
    /// Returns the force of the law that the device can bear, without slew.
    [[nodiscard]] Vec3 limitedAt(const Reading& reading, double soft) const {
        const auto& felt = reading.felt;
        const double stiffest = limits_.gain * felt.stiffness * limits_.scale;  // [N/m]
        const double gain = soft * limits_.gain * (stiffest > limits_.stiffness ? limits_.stiffness / stiffest : 1);
        const Vec3 push = gain * felt.push;
        const Vec3 slip = sand::force::rubbing(felt, reading.velocity);
        const double speed = norm(slip);
        const double law = gain * felt.drag * limits_.scale / 60;  // [N s/m]
        const double viscous = std::min(law / (1 + 2 * law * 0.001 / limits_.arm.mass), limits_.damping);
        const double held = reading.talus * norm(push);
        return push - (viscous * speed > held ? held / speed : viscous) * slip;
    }

private:
    static constexpr double kLate = 0.01, kRounding = 1e-6;  // [s]

    [[nodiscard]] bool hasFault(const Reading& reading, double span, bool first, bool late) const {
        const Vec3 law =
            reading.engaged ? sand::force::lawfulForce(reading.felt, (limits_.scale / 60) * reading.velocity) : Vec3{};
        const bool numbers = std::isfinite(norm(law)) && std::isfinite(norm(reading.place)) &&
                             std::isfinite(norm(reading.velocity)) && std::isfinite(reading.felt.stiffness) &&
                             std::isfinite(reading.talus) && std::isfinite(reading.share);
        const double way = first || late ? 0 : norm(reading.place - place_);
        const bool jumped = way > limits_.fastestThing * std::max(silence_ + span, 0.001) + 2 * limits_.resolution;
        return !numbers || (!reading.present && !late) || reading.tripped || !(reading.surfaceAge <= 0.05) ||
               !(span >= 0 && span <= 0.01) || jumped;
    }
    /// The share of operators and clutch: half a second to grow, a twentieth to fall. It begins at once.
    double shareAfter(double passed, double wanted, bool first) {
        wanted = wanted > 0 ? std::min(wanted, 1.0) : 0;
        const double step = std::min(passed, 0.05);
        if (first) {
            share_ = wanted;
        } else if (wanted > share_) {
            share_ = std::min(share_ + step / 0.5, wanted);
        } else {
            share_ = std::max(share_ - step / 0.05, wanted);
        }
        return share_;
    }
    /// Sand without steps: a tenth of a second to fade, a second of steps, and half a second to grow.
    double movingAfter(double passed, double age) {
        const bool old = !(age <= std::max(0.25, 3 * limits_.stepSeconds));
        steady_ = old ? 0 : steady_ + passed;
        frozen_ = old || (frozen_ && steady_ < 1);
        moving_ = frozen_ ? std::max(moving_ - passed / 0.1, 0.0) : std::min(moving_ + passed / 0.5, 1.0);
        return moving_;
    }
    /// A late step lowers the stiffness at once; it comes back within half a second.
    double softnessAfter(double passed, double age) {
        const double bearable = limits_.shareForStepOf(age);
        sinceLow_ += passed;
        const double rising = lowest_ + (1 - lowest_) * std::min(sinceLow_ / 0.5, 1.0);
        if (bearable > rising) {
            return rising;
        }
        lowest_ = bearable;
        sinceLow_ = 0;
        return bearable;
    }

    haptic_bridge::ForceLimits limits_;
    bool begun_ = false;
    double time_ = 0;
    bool heard_ = false;  // a reading came, and since then only silence
    double silence_ = 0;  // [s], since the last reading
    Vec3 place_;
    double share_ = 0;
    double steady_ = 0, moving_ = 1;
    bool frozen_ = false;
    double lowest_ = 1, sinceLow_ = 0;
};

}  // namespace test
