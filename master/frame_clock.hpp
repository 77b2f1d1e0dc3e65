// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "master/steps/step_source.hpp"

namespace master {

/// A swap of the wall.
struct Swap {
    std::int64_t at = 0;        // [ns]
    std::int64_t interval = 0;  // since the one before [ns]; 0 at the first
    bool first = false;         // of this session

    [[nodiscard]] double milliseconds() const { return static_cast<double>(interval) * 1e-6; }
};

/// Says when the frames of a wall begin: at its refresh rate, on a grid of times; or at once in a fast session. With
/// eyes in turn a frame shows one eye, so that 120 Hz gives each eye 60 pictures a second.
///
/// Reads no clock: the caller tells the time, so that tests need not wait. Used by one thread.
class FrameClock {
public:
    /// `refreshHz` is positive [frames per second].
    explicit FrameClock(double refreshHz, Pace pace = Pace::realtime) : period_(1 / refreshHz), pace_(pace) {}

    [[nodiscard]] double period() const { return period_; }  // [s]
    [[nodiscard]] Pace pace() const { return pace_; }
    /// Returns when the next frame begins at the earliest [ns]. A fast session waits only while it is `held`: while no
    /// steps are taken.
    [[nodiscard]] std::int64_t next(bool held = false) const { return atOnce(held) ? 0 : start_ + periodNs(); }
    /// Begins the next frame at the time `now` [ns]. Returns for how long to wait before [ns], 0 if it is due. A frame
    /// that is late does not delay those after it; after more than a period they go by a new grid.
    [[nodiscard]] std::int64_t begin(std::int64_t now, bool held = false);

    /// Tells that the wall has swapped at the time `now` [ns].
    Swap swapped(std::int64_t now);
    /// Returns the time since the last swap [s]; 0 before the first.
    [[nodiscard]] double sinceSwap(std::int64_t now) const;
    [[nodiscard]] std::int64_t lastSwap() const { return last_; }  // [ns]; 0 before the first
    /// Returns the time from the first swap to the last [s].
    [[nodiscard]] double seconds() const { return static_cast<double>(last_ - first_) * 1e-9; }
    /// Returns the time of the session at which frame `frame` is seen [s]. A fast session shows each frame what a
    /// recorded head did then, however long the frame takes.
    [[nodiscard]] double timeOf(std::uint64_t frame, std::int64_t now = 0) const;

private:
    [[nodiscard]] std::int64_t periodNs() const { return static_cast<std::int64_t>(1e9 * period_); }
    [[nodiscard]] bool atOnce(bool held) const { return pace_ == Pace::fast && !held; }

    double period_;  // [s]
    Pace pace_;
    std::int64_t start_ = 0;             // [ns], of the frame before
    std::int64_t first_ = 0, last_ = 0;  // [ns], swaps
};

}  // namespace master
