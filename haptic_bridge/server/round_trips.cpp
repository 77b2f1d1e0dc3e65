// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/round_trips.hpp"

#include <utility>

namespace haptic_bridge {
namespace {

HalfRoundTrip halfRoundTripOf(const base::LiveHistogram& halves) {
    return {halves.meanNs() * 1e-6, halves.stddevNs() * 1e-6, halves.percentileNs(0.50) * 1e-6,
            halves.percentileNs(0.99) * 1e-6, halves.count()};
}

}  // namespace

double RoundTrips::pause() {
    // Poisson arrivals see time averages: no phase of a frame is sampled more often than its share of the time.
    return std::exponential_distribution<double>(perSecond_)(random_);
}

TimingTest RoundTrips::next(std::size_t bytes, std::int64_t nowNs) {
    TimingTest test{++last_, 0};
    const std::size_t bare = encode(test).size();
    test.padding = static_cast<std::uint32_t>(bytes > bare ? bytes - bare : 0);
    out_[test.id].sentNs = nowNs;
    if (out_.size() > kMostOut) {
        out_.erase(out_.begin());
    }
    return test;
}

void RoundTrips::echoed(const TimingEcho& echo, std::int64_t nowNs) {
    const auto test = out_.find(echo.id);
    if (test == out_.end()) {
        return;
    }
    const std::int64_t half = (nowNs - test->second.sentNs) / 2;
    if (echo.leg == Leg::shown) {
        toWall_.add(half);
        out_.erase(test);
    } else if (!std::exchange(test->second.received, true)) {
        toMaster_.add(half);
    }
}

void RoundTrips::fill(Report& report) const {
    report.toWall = halfRoundTripOf(toWall_);
    report.toMaster = halfRoundTripOf(toMaster_);
}

}  // namespace haptic_bridge
