// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "sand/model/step.hpp"

namespace haptic_bridge {

/// One reading of the hand.
struct HandSample {
    std::int64_t timeNs = 0;  // monotonic
    sand::ProbePoint at;
    bool engaged = false;
    std::optional<sand::Heading> heading = std::nullopt;  // none: the hand does not turn the tool
};

/// Gathers hand samples and cuts them into the paths of steps.
///
/// A step is engaged or not as a whole, so it takes the samples up to the next change between the two; what follows is
/// left to the step after. Points where the hand rests are left out. A path too long for a step keeps its first and its
/// last point and, between them, points at even distances in the order of time. Not thread-safe.
///
/// Who is late catches up by steps that hold more than a step's time, but not much more: a path costs by its length,
/// and one path of all that waits would make its wall later still. A hand that is too far ahead is let go: the tool is
/// lifted, and put down where the hand is now.
class PathBuilder {
public:
    static constexpr std::int64_t kMostPeriods = 4;                // of hand that a step holds
    static constexpr std::int64_t kFarthestAhead = 1'000'000'000;  // [ns] that the hand is

    /// Beyond this many waiting samples every second one is thinned out, so that a blocked link costs bounded memory.
    static constexpr std::size_t kMaxWaiting = 4096;

    explicit PathBuilder(int stepsPerSecond) : mostNs_(kMostPeriods * 1'000'000'000 / stepsPerSecond) {}

    void add(const HandSample& sample);
    /// Fills engaged, path, and heading with the last that the hand gave. Returns when the last point was read [ns], 0
    /// when no sample waited: the hand is then where it was, engaged as it was.
    std::int64_t take(sand::Step& step);
    /// Forgets what waits, and where the hand was.
    void restart(sand::ProbePoint at, bool engaged);
    void dropWaiting();
    /// Samples that were thinned out, let go, or dropped while they waited.
    [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

private:
    void thinWaiting();
    [[nodiscard]] std::int64_t waitingNs() const { return waiting_.back().timeNs - waiting_.front().timeNs; }
    void letGoIfFarAhead();

    std::int64_t mostNs_;  // [ns] of hand that a step holds
    std::deque<HandSample> waiting_;
    sand::ProbePoint last_;
    bool engaged_ = false;
    std::uint64_t dropped_ = 0;
};

/// Keeps at most `most` (≥ 2) of the points: first, last, and evenly chosen ones between.
void thin(std::vector<sand::ProbePoint>& path, std::size_t most);

}  // namespace haptic_bridge
