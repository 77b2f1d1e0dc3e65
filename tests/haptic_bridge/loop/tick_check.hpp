// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "tests/haptic_bridge/loop/fuzz_count.hpp"
#include "tests/haptic_bridge/loop/push_oracle.hpp"
#include "tests/haptic_bridge/loop/virtual_server.hpp"

namespace test {

/// Checks each tick of a server: its push, and its record.
class TickCheck {
public:
    TickCheck(const scene::Scene& scene, const haptic_bridge::HandSettings& settings,
              const haptic_bridge::ForceLimits& limits)
        : scene_(scene), settings_(settings), limits_(limits), arm_(limits), push_(limits), oracle_(limits) {}

    /// Returns what is wrong with the last tick of `server`; empty if it keeps all rules.
    [[nodiscard]] std::string wrong(VirtualServer& server) {
        if (server.pushes.size() != ++ticks_) {
            return "a tick does not push once";
        }
        const sand::force::Vec3 pushed = server.pushed();
        if (std::string bad = arm_.wrong(pushed); !bad.empty()) {
            return "the arm: " + bad;
        }
        if (!server.moving()) {
            return norm(pushed) == 0 ? "" : "a hand at rest is pushed";
        }
        const haptic_bridge::Tick& tick = server.last();
        counts.add(tick.guards);
        if (norm(pushed - alongTheArm(tick.sent)) > (settings_.verticalScale == 1 ? 0 : 1e-12 * norm(pushed))) {
            return "the arm does not get what the record says";
        }
        if (std::exchange(sitting_, server.sitting()) != server.sitting()) {
            model_ = sand::force::ForceModel(scene_.force);
            oracle_.forget();
            push_.start(tick.time);
            edit_ = 0;
        }
        if (server.hand().lastInput().tripped != trips_) {
            return trips_ ? "a fourth ramp is felt" : "the force is off although too few faults came";
        }
        const bool late = server.hand().lastInput().silent && oracle_.mayBeLate(tick.time);
        if (tick.edited != (edit_ != 0 && tick.surfaceStep >= edit_ && !late)) {
            return "another tick than the first one after an edit feels it";
        }
        edit_ = tick.edited ? 0 : edit_;
        PushCheck::Asked asked = oracle_.next(readingOf(tick, server, late));
        const std::uint32_t faults = tick.guards & haptic_bridge::kFaults;
        countFault(tick.time, (faults & ~bit(haptic_bridge::Guard::tripped)) != 0);
        if (asked.fault != (faults != 0) && tick.engaged) {
            return asked.fault ? "no guard has acted at a fault" : "a guard has acted without a fault";
        }
        asked.fault = asked.fault || faults != 0;
        asked.damped = (tick.guards & bit(haptic_bridge::Guard::passivity)) != 0;
        return push_.wrong(tick.sent, asked);
    }

    /// Tells that the step of this number has an edit.
    void expectEdit(std::uint64_t step) { edit_ = step; }

    /// Tells that an operator has switched the force on.
    void expectForce() {
        trips_ = fault_ = false;
        faults_.clear();
    }

    ActedCounts counts;

private:
    /// Counts ramps: three in ten seconds switch the force off.
    void countFault(double time, bool fault) {
        if (fault && !fault_) {
            faults_.push_back(time);
            trips_ = trips_ || (faults_.size() >= 3 && time - faults_[faults_.size() - 3] <= 10);
        }
        fault_ = fault;
    }
    /// Makes the input of the guards again, with a law of its own.
    [[nodiscard]] haptic_bridge::Guards::Reading readingOf(const haptic_bridge::Tick& tick, VirtualServer& server,
                                                           bool late) {
        const haptic_bridge::TickInput& input = server.hand().lastInput();
        haptic_bridge::Guards::Reading reading{.time = tick.time,
                                               .present = input.reading.present,
                                               .silent = input.silent,
                                               .tripped = input.tripped,
                                               .engaged = tick.engaged,
                                               .edited = tick.edited,
                                               .surfaceAge = tick.surfaceAge,
                                               .stepAge = tick.stepAge,
                                               .share = input.reading.second ? 0 : tick.share,
                                               .talus = tick.talus,
                                               .place = (1 / limits_.scale) * tick.place,
                                               .velocity = (1 / limits_.scale) * tick.velocity,
                                               .felt = {}};
        if (tick.engaged && !late) {
            const haptic_bridge::FeltSand& felt = server.felt();
            reading.felt = model_.at(felt.patch, felt.step, felt.tool, tick.place, tick.time, tick.edited);
        }
        return reading;
    }
    [[nodiscard]] sand::force::Vec3 alongTheArm(sand::force::Vec3 force) const {
        const double longest = std::max(1.0, settings_.verticalScale);
        const std::array<double, 3> felt{force.x / longest, force.y / longest,
                                         settings_.verticalScale * force.z / longest};
        std::array<double, 3> to{};
        for (std::size_t i = 0; i < 3; ++i) {
            const auto& axis = settings_.axes.at(i);
            to.at(static_cast<std::size_t>(axis.column)) = axis.sign * felt.at(i);
        }
        return {to[0], to[1], to[2]};
    }

    const scene::Scene& scene_;
    const haptic_bridge::HandSettings& settings_;
    haptic_bridge::ForceLimits limits_;
    PushCheck arm_, push_;
    PushOracle oracle_;
    sand::force::ForceModel model_{scene_.force};
    std::size_t ticks_ = 1;  // the server has read its hand once
    std::uint32_t sitting_ = 0;
    std::vector<double> faults_;  // [s], when faults began
    bool fault_ = false, trips_ = false;
    std::uint64_t edit_ = 0;  // number of a step with an edit that no tick has felt yet, or 0
};

}  // namespace test
