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
    std::int64_t readNs = 0;  // [ns], monotonic clock, or a virtual one
    sand::ProbePoint probe{};
    bool engaged = false;
    std::optional<sand::Heading> heading = std::nullopt;  // nullopt: the hand does not turn the tool
    bool read = true;  // false: a place that was computed at `readNs`, and at which no hand was read
};

/// Most sub-steps of an engaged tool in the path of a step.
struct SubstepLimit {
    static constexpr std::int64_t kNone = INT64_MAX;
    std::int64_t wanted = kNone;                // a path that ends at its first point may have more
    std::int64_t most = kNone;                  // the way to the first point is divided if it has more
    std::int32_t length = sand::kProbePerCell;  // Rules::substepLength() [probe unit]
    bool onlyHovering = false;                  // engaged samples wait
};

/// Gathers hand samples and cuts them into the paths of steps. Not thread-safe.
///
/// A step is engaged or hovering as a whole. A path therefore ends where the samples change between the two, and the
/// next step takes the rest. Points at which the hand rests are left out. A path that is too long for a step keeps its
/// first and its last point, and evenly chosen points in between. The points stay in the order of time.
///
/// Samples wait while a slow wall holds the server back, and engaged ones while sweeps are owed. A later step then
/// holds up to kMostPeriods periods of an engaged hand, and no more sub-steps of the tool than its caller allows. It
/// holds no more, because a longer path takes longer to apply, and the wall would fall further behind. A step takes all
/// waiting samples of a hand that hovers, because they move no sand. If the waiting samples span more than
/// kFarthestAhead and begin engaged, only the last kMostPeriods periods of them are kept. The tool is then lifted, and
/// put down where these samples begin.
class PathBuilder {
public:
    static constexpr std::int64_t kMostPeriods = 4;  // [period of a step] of engaged movement that a step may hold
    static constexpr std::int64_t kFarthestAhead = 1'000'000'000;  // [ns], longest time that the waiting samples span

    /// Number of waiting samples above which every second one is dropped, so that a blocked link costs bounded memory.
    static constexpr std::size_t kMaxWaiting = 4096;

    explicit PathBuilder(int stepsPerSecond) : mostNs_(kMostPeriods * 1'000'000'000 / stepsPerSecond) {}

    void add(const HandSample& sample);
    /// Fills `step.engaged`, `step.path` and the hand's last heading from waiting samples. Returns the time at which
    /// the last sample was read [ns], or 0 if the step has no sample that was read. If no sample waits, the hand is
    /// where it was, and the step is engaged as the one before. The path keeps within `limit`.
    std::int64_t take(sand::Step& step, const SubstepLimit& limit = {});
    /// Returns when the oldest engaged sample that waits and moves the tool was read [ns]. Returns nullopt if no such
    /// sample waits.
    [[nodiscard]] std::optional<std::int64_t> engagedSinceNs() const;
    /// Returns whether samples wait.
    [[nodiscard]] bool waits() const { return !waiting_.empty(); }
    /// Returns whether a waiting sample moves the tool: displaces it, turns it, or changes whether it is engaged.
    [[nodiscard]] bool moves() const;
    /// Forgets the waiting samples of a hand that does not move. They do not count as dropped, because no step
    /// would change with them.
    void forgetRest() { waiting_.clear(); }
    /// Forgets all waiting samples. The hand now hovers at `probe`.
    void restart(sand::ProbePoint probe);
    /// Drops all waiting samples and counts them.
    void dropWaiting();
    /// Returns the number of samples that were dropped: engaged samples that were thinned out of a step, and waiting
    /// samples that were thinned out, were too far ahead, or waited when dropWaiting() was called.
    [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

private:
    void thinWaiting();
    [[nodiscard]] std::int64_t waitingNs() const { return waiting_.back().readNs - waiting_.front().readNs; }
    void letGoIfFarAhead();
    /// Brings the tool nearer to `goal` by the most sub-steps of `limit`. Returns the point that it reaches.
    sand::ProbePoint approach(const sand::ProbePoint& goal, const SubstepLimit& limit);

    std::int64_t mostNs_;  // [ns] of engaged movement that a step may hold
    std::deque<HandSample> waiting_;
    sand::ProbePoint last_;
    bool engaged_ = false;
    std::uint64_t dropped_ = 0;
};

/// Reduces `path` to at most `most` (≥ 2) points: the first, the last, and evenly chosen ones in between.
void thin(std::vector<sand::ProbePoint>& path, std::size_t most);

}  // namespace haptic_bridge
