// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "haptic_bridge/hand/pace.hpp"

namespace master {

/// One swap of the wall: the moment after the master has sent the verdict that all ranks agree. Each rank swaps when it
/// has the verdict.
struct Swap {
    std::int64_t timeNs = 0;    // of that moment
    std::int64_t interval = 0;  // [ns], since the swap before; 0 at the first swap
    bool first = false;         // the first swap of this process

    [[nodiscard]] double milliseconds() const { return static_cast<double>(interval) * 1e-6; }
};

/// Times at which the frames of a wall begin.
///
/// Frames begin on a grid of times, at the wall's refresh rate. In a fast session each frame begins at once. With
/// active stereo a frame may show one eye only: 120 Hz then gives each eye 60 pictures a second.
///
/// Reads no clock: the caller passes the time, so that tests need not wait. Used by one thread.
class FrameClock {
public:
    /// `refreshHz` is positive [frames per second].
    explicit FrameClock(double refreshHz, haptic_bridge::Pace pace = haptic_bridge::Pace::realtime)
        : period_(1 / refreshHz), pace_(pace) {}

    [[nodiscard]] double period() const { return period_; }  // [s]
    [[nodiscard]] haptic_bridge::Pace pace() const { return pace_; }
    /// Returns the earliest time at which the next frame begins [ns]; 0 means at once. A fast session waits only while
    /// it is `held`, which means that it takes no steps.
    [[nodiscard]] std::int64_t next(bool held = false) const { return atOnce(held) ? 0 : start_ + periodNs(); }
    /// Begins the next frame. `now` is the present time [ns]. Returns how long the caller must wait first [ns]; 0 if
    /// the frame is due. A late frame does not delay later frames. If it is late by more than a period, a new grid
    /// begins at `now`.
    [[nodiscard]] std::int64_t begin(std::int64_t now, bool held = false);

    /// Notes that the wall swapped at the time `now` [ns], and returns this swap.
    Swap swapped(std::int64_t now);
    /// Returns the time from the last swap to `now` [s]; 0 before the first swap.
    [[nodiscard]] double sinceSwap(std::int64_t now) const;
    [[nodiscard]] std::int64_t lastSwap() const { return last_; }  // [ns]; 0 before the first swap
    /// Returns the time from the first swap to the last swap [s].
    [[nodiscard]] double seconds() const { return static_cast<double>(last_ - first_) * 1e-9; }
    /// Returns the session's time of frame `frame` [s]. A recorded head is shown as it was at this time. In real time
    /// it is the time from the first swap to `now` [ns], and 0 before that swap. In a fast session it is counted in
    /// frames, however long each frame takes.
    [[nodiscard]] double timeOf(std::uint64_t frame, std::int64_t now = 0) const;

private:
    [[nodiscard]] std::int64_t periodNs() const { return static_cast<std::int64_t>(1e9 * period_); }
    [[nodiscard]] bool atOnce(bool held) const { return pace_ == haptic_bridge::Pace::fast && !held; }

    double period_;  // [s]
    haptic_bridge::Pace pace_;
    std::int64_t start_ = 0;             // [ns], begin of the frame before
    std::int64_t first_ = 0, last_ = 0;  // [ns], first and last swap; 0 before the first
};

}  // namespace master
