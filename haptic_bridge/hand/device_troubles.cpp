// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/device_troubles.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace haptic_bridge {
namespace {

std::string lineOf(const std::string& name, Trouble trouble, std::uint64_t times) {
    switch (trouble) {
        case Trouble::absent:
            return fmt::format("{} does not answer; the tool is lifted and the hand feels nothing until it answers",
                               name);
        case Trouble::noNumber:
            return fmt::format(
                "{} sends values that are not finite, {} times so far; the tool is lifted and the hand feels nothing",
                name, times);
        case Trouble::jump:
            return fmt::format("{} jumps, {} times so far; the tool is lifted, and put down at the new place", name,
                               times);
        case Trouble::backwards:
            return fmt::format("{} runs backwards in time, {} readings so far were ignored", name, times);
        case Trouble::flood:
            return fmt::format("{} sends more than the master can take in, and was held back {} times so far", name,
                               times);
    }
    return {};
}

}  // namespace

std::vector<std::string> TroubleReporter::lines(const TroubleCounts& counts, double time) {
    std::vector<std::string> result;
    for (std::size_t i = 0; i < kTroubles; ++i) {
        const auto trouble = static_cast<Trouble>(i);
        const std::uint64_t now = counts.of(trouble);
        Reported& reported = reported_[i];
        if (now == reported.seen) {
            if (trouble == Trouble::absent && away_ && time - reported.grew >= kOver) {
                away_ = false;
                reported.lastLine = -kQuiet;
                result.push_back(fmt::format("{} answers again", name_));
            }
            continue;
        }
        reported.seen = now;
        reported.grew = time;
        if (time - reported.lastLine >= kQuiet && !(trouble == Trouble::absent && away_)) {
            reported.lastLine = time;
            away_ = away_ || trouble == Trouble::absent;
            result.push_back(lineOf(name_, trouble, now));
        }
    }
    return result;
}

bool ReadingCheck::accept(double time, sand::force::Vec3 place) {
    if (!std::isfinite(time) || !std::isfinite(place.x) || !std::isfinite(place.y) || !std::isfinite(place.z)) {
        counts_.count(Trouble::noNumber);
        return false;
    }
    if (known_ && time < time_) {
        counts_.count(Trouble::backwards);
        return false;
    }
    const bool jumped = known_ && norm(place - place_) > farthest_;
    known_ = true;
    time_ = time;
    place_ = place;
    if (jumped) {
        counts_.count(Trouble::jump);
    }
    return !jumped;
}

}  // namespace haptic_bridge
