// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <utility>

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
        if (tick.edited != (edit_ != 0 && tick.surfaceStep >= edit_)) {
            return "another tick than the first one after an edit feels it";
        }
        edit_ = tick.edited ? 0 : edit_;
        PushCheck::Asked asked = oracle_.next(readingOf(tick, server));
        const std::uint32_t faults = tick.guards & kFaults;
        if (asked.fault != (faults != 0) && tick.engaged) {
            return asked.fault ? "no guard has acted at a fault" : "a guard has acted without a fault";
        }
        asked.fault = asked.fault || faults != 0;
        return push_.wrong(tick.sent, asked);
    }

    /// Tells that the step of this number has an edit.
    void expectEdit(std::uint64_t step) { edit_ = step; }

    ActedCounts counts;

private:
    static constexpr std::uint32_t kFaults = bit(haptic_bridge::Guard::notANumber) | bit(haptic_bridge::Guard::stale) |
                                             bit(haptic_bridge::Guard::missed) | bit(haptic_bridge::Guard::lost) |
                                             bit(haptic_bridge::Guard::jumped);

    /// Makes the input of the guards again, with a law of its own.
    [[nodiscard]] haptic_bridge::Guards::Reading readingOf(const haptic_bridge::Tick& tick, VirtualServer& server) {
        const haptic_bridge::TickInput& input = server.hand().lastInput();
        haptic_bridge::Guards::Reading reading{.time = tick.time,
                                               .present = input.reading.present,
                                               .engaged = tick.engaged,
                                               .edited = tick.edited,
                                               .surfaceAge = tick.surfaceAge,
                                               .stepAge = tick.stepAge,
                                               .share = input.reading.second ? 0 : tick.share,
                                               .talus = tick.talus,
                                               .place = (1 / limits_.scale) * tick.place,
                                               .velocity = (1 / limits_.scale) * tick.velocity,
                                               .felt = {}};
        if (tick.engaged) {
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
    std::uint64_t edit_ = 0;  // number of a step with an edit that no tick has felt yet, or 0
};

}  // namespace test
