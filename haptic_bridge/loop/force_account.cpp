// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/force_account.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "haptic_bridge/loop/guards/limited_law.hpp"

namespace haptic_bridge {
namespace {

constexpr double kHalf = 0.5;
constexpr std::uint32_t kGrowth = bit(Guard::contact) | bit(Guard::gate) | bit(Guard::slew) | bit(Guard::edit);

std::optional<ForceOutcome> faultIn(std::uint32_t acted) {
    using enum ForceOutcome;
    static constexpr std::array kOutcomes{std::pair{Guard::tripped, tripped}, std::pair{Guard::notANumber, notANumber},
                                          std::pair{Guard::stale, stale},     std::pair{Guard::missed, missed},
                                          std::pair{Guard::lost, lost},       std::pair{Guard::jumped, jumped}};
    for (const auto& [guard, outcome] : kOutcomes) {
        if ((acted & bit(guard)) != 0) {
            return outcome;
        }
    }
    return std::nullopt;
}

/// Returns whether the wall takes no steps for a reason that it tells. When that ends, the next steps take a moment.
bool isHeld(ForceOutcome cause) {
    return cause == ForceOutcome::pause || cause == ForceOutcome::disk || cause == ForceOutcome::start;
}

}  // namespace

double askedForce(const Guards& guards, const Guards::Reading& reading, sand::force::Vec3 lawful) {
    if (guards.mode() == Guards::Mode::literal) {
        return norm(lawful);
    }
    std::uint32_t ignored = 0;
    // Softness 1: a force that is softer because a step comes late is less than what the law asks for.
    const LimitsNow limits(guards.limits(), 1, reading.talus);
    const double limited = norm(limitedForce(reading.felt, reading.velocity, limits, ignored));
    return std::isfinite(limited) ? std::min(limited, guards.limits().maxForce) : limited;
}

std::optional<ForceOutcome> stoppedBy(const SandAge& age, double stepSeconds) {
    using enum ForceOutcome;
    const double oldest = std::max(FrozenSand::kOldest, FrozenSand::kOldestSteps * stepSeconds);
    if (age.felt <= oldest) {
        return std::nullopt;
    }
    if (!age.held) {
        return start;
    }
    if (*age.held != Held::no) {
        return *age.held == Held::pause ? pause : disk;
    }
    return age.made <= oldest ? slowMotion : steps;
}

std::optional<ForceOutcome> ForceAccount::tick(const Tick& now) {
    if (now.asked && std::isfinite(*now.asked)) {
        asked_ = *now.asked;
    }
    rampBy_ = faultIn(now.acted).value_or(rampBy_);
    if (now.stopped && (isHeld(*now.stopped) || now.time >= heldUntil_)) {
        stoppedBy_ = *now.stopped;
        heldUntil_ = isHeld(stoppedBy_) ? now.time + FrozenSand::kSteady : 0;
    }
    if (now.clutch || now.share <= kHalf) {
        using enum ForceOutcome;
        chosenBy_ = now.clutch ? clutch : now.share > 0 ? share : off;
        chosenUntil_ = now.time + FeltShare::kRampSeconds;
    }
    return asked_ > 0 ? std::optional(outcomeOf(now)) : std::nullopt;
}

/// Returns the choice of a person that leaves the hand less than half; nullopt if there is none.
std::optional<ForceOutcome> ForceAccount::chosen(const Tick& now) const {
    if (now.clutch || now.share <= kHalf) {
        return chosenBy_;
    }
    if (now.share < 1 && now.sent >= kHalf * now.share * asked_) {
        return ForceOutcome::share;
    }
    return now.stopped == ForceOutcome::pause ? now.stopped : std::nullopt;
}

ForceOutcome ForceAccount::outcomeOf(const Tick& now) const {
    if (now.sent >= kHalf * asked_) {
        return ForceOutcome::half;
    }
    if (const auto choice = chosen(now)) {
        return *choice;
    }
    if (const auto fault = faultIn(now.acted)) {
        return *fault;
    }
    if ((now.acted & bit(Guard::unread)) != 0) {
        return ForceOutcome::lost;
    }
    if ((now.acted & bit(Guard::frozen)) != 0) {
        return stoppedBy_;
    }
    if ((now.acted & bit(Guard::ramp)) != 0) {
        return rampBy_;
    }
    if (now.time < chosenUntil_) {
        return chosenBy_;
    }
    return (now.acted & kGrowth) != 0 ? ForceOutcome::growth : ForceOutcome::damped;
}

}  // namespace haptic_bridge
