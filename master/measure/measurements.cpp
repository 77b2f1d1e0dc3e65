// SPDX-License-Identifier: Apache-2.0
#include "master/measure/measurements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "host/event.hpp"
#include "host/json_fields.hpp"

namespace master {
namespace {

constexpr double kLate = 1.5;  // a late frame takes more than this many periods
constexpr std::int64_t kSecondNs = 1'000'000'000;

double milliseconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-6; }

}  // namespace

Measurements::Measurements(std::size_t ranks, std::uint64_t from, double period, haptic_bridge::Pace pace,
                           int stepsPerSecond)
    : from_(from), period_(period), pace_(pace), ranks_(ranks), slowMotion_(stepsPerSecond) {}

void Measurements::add(const Frame& frame, const ArrivedSteps& steps, const std::vector<lockstep::Arrival>& arrivals,
                       std::int64_t clockOffset) {
    broadcastBytes_.add(static_cast<double>(frame.bytes));
    addSwaps(frame, arrivals);
    addLatency(frame, steps, arrivals, clockOffset);
    const bool counts = !frame.swap.first && frame.held == haptic_bridge::Held::no;
    if (counts && frame.rests) {
        restSeconds_ += 1e-9 * static_cast<double>(frame.swap.interval);
        slowMotion_.addRest(frame.swap.interval);
    } else {
        slowMotion_.add(counts ? frame.swap.interval : 0, steps);
    }
}

std::optional<double> Measurements::slowMotion() const {
    return pace_ == haptic_bridge::Pace::realtime ? slowMotion_.factor() : std::nullopt;
}

void Measurements::addSwaps(const Frame& frame, const std::vector<lockstep::Arrival>& arrivals) {
    const bool counts = frame.number > from_ + 1;
    // Arrivals contain the swap time of the frame before. The first frame has no frame before it.
    ranks_.add(arrivals, !frame.swap.first && counts);
    if (frame.swap.first) {
        return;
    }
    lastFrameMs_ = frame.swap.milliseconds();
    pausedSeconds_ += frame.held == haptic_bridge::Held::pause ? 1e-3 * lastFrameMs_ : 0;
    fullDiskSeconds_ += frame.held == haptic_bridge::Held::disk ? 1e-3 * lastFrameMs_ : 0;
    if (counts) {
        frameMs_.add(lastFrameMs_);
        lateFrames_ += pace_ == haptic_bridge::Pace::realtime && lastFrameMs_ > kLate * 1e3 * period_ ? 1 : 0;
    }
    const std::vector<std::uint32_t>& swaps = ranks_.lastSwapsUs();
    if (!swaps.empty()) {
        lastSkewUs_ = *std::max_element(swaps.begin(), swaps.end());
        skewUs_.add(lastSkewUs_);
    }
}

void Measurements::addLatency(const Frame& frame, const ArrivedSteps& steps,
                              const std::vector<lockstep::Arrival>& arrivals, std::int64_t clockOffset) {
    std::int64_t drawn = frame.broadcast;
    for (std::size_t rank = 1; rank < arrivals.size(); ++rank) {
        drawn = std::max(drawn, arrivals[rank].arrived);
    }
    for (const ArrivedStep& timed : steps) {
        if (timed.serverTimeNs == 0) {  // the master made this step
            continue;
        }
        const std::int64_t sent = timed.serverTimeNs - clockOffset;
        latency_.toMaster.add(milliseconds(timed.receivedNs - sent));
        latency_.queued.add(milliseconds(frame.broadcast - timed.receivedNs));
        latency_.drawn.add(milliseconds(drawn - frame.broadcast));
        latency_.swapped.add(milliseconds(frame.swap.timeNs - drawn));
        latency_.wholeWay.add(milliseconds(frame.swap.timeNs - sent));
    }
}

bool Measurements::progressIsDue(const Progress& now, std::int64_t nowNs) const {
    const bool changed = now.step != progress_.step || now.hand != progress_.hand;
    return now.last || changed || static_cast<double>(nowNs - progressNs_) * 1e-9 >= now.repeat;
}

void Measurements::printProgress(const Progress& now, std::int64_t nowNs, Reader reader) {
    if (!now.last && nowNs - countedNs_ < kSecondNs) {
        return;
    }
    const double seconds = static_cast<double>(nowNs - countedNs_) * 1e-9;
    fps_ = countedNs_ == 0 ? 0 : static_cast<double>(now.frame - countedFrame_) / seconds;
    if (reader == Reader::digs) {
        printFrameRate(now.last);
    }
    countedNs_ = nowNs;
    countedFrame_ = now.frame;
    if (!progressIsDue(now, nowNs)) {
        return;
    }
    progressNs_ = nowNs;
    progress_ = now;
    if (reader == Reader::operates) {
        fmt::print("frame {}  step {}{}  {:.1f} fps  skew {:.0f} us  hashes agree  {}\n", now.frame, now.step, now.of,
                   fps_, lastSkewUs_, now.hand);
        std::fflush(stdout);
    }
    host::emitEvent(
        "progress",
        {{"frame", now.frame}, {"step", now.step}, {"fps", fps_}, {"skew_us", lastSkewUs_}, {"hand", now.hand}});
}

/// Leaves out the first second, which has the start, and the last frames, which are too few for a rate.
void Measurements::printFrameRate(bool last) {
    constexpr double kNoticed = 0.1;  // share of the printed rate
    if (!last && countedFrame_ > 1 && std::abs(fps_ - printedFps_) > kNoticed * printedFps_) {
        fmt::print("{:.0f} pictures a second\n", fps_);
        std::fflush(stdout);
        printedFps_ = fps_;
    }
}

lockstep::WallFigures Measurements::figures(const Incidents& incidents, std::int32_t sweepsOwed) const {
    return {.frameMs = lastFrameMs_,
            .slowest = ranks_.recentDrag(),
            .agreed = ranks_.frames(),
            .divergences = incidents.divergences,
            .healed = incidents.healed,
            .unplaced = incidents.stepsUnplaced,
            .sweepsOwed = sweepsOwed,
            .slowMotion = slowMotion(),
            .dark = {},
            .swaps = ranks_.lastSwapsUs()};
}

void Measurements::describe(nlohmann::json& status, const std::vector<std::string>& names) const {
    status["fps"] = fps_;
    status["slow_motion"] = host::jsonOf<nlohmann::json>(slowMotion());
    status["slowest"] = host::jsonOf<nlohmann::json>(slowestRank(ranks_.recentDrag(), names));
}

void Measurements::fill(Summary& summary) const {
    summary.frameMs = frameMs_;
    summary.lateFrames = lateFrames_;
    summary.hand.frames = framesWithHand_;
    summary.hand.atEnd = handed_;
    summary.hand.slowMotion = slowMotion();
    summary.pausedSeconds = pausedSeconds_;
    summary.fullDiskSeconds = fullDiskSeconds_;
    summary.restSeconds = restSeconds_;
    summary.skewUs = skewUs_;
    summary.broadcastBytes = broadcastBytes_;
    summary.latency = latency_;
    summary.rankStatistics = ranks_.ranks();
    summary.drag = ranks_.drag();
}

}  // namespace master
