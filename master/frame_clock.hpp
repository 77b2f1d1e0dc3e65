// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace master {

/// Says when the frames of a wall begin: at its refresh rate, on a grid of times. With eyes in turn a frame shows one
/// eye, so that 120 Hz gives each eye 60 pictures a second.
///
/// Reads no clock: the caller tells the time, so that tests need not wait. Used by one thread.
class FrameClock {
public:
    /// `refreshHz` is positive [frames per second].
    explicit FrameClock(double refreshHz) : period_(1 / refreshHz) {}

    [[nodiscard]] double period() const { return period_; }  // [s]
    /// Returns the time at which frame `frame` of a session begins that counts its time in frames [s].
    [[nodiscard]] double timeOf(std::uint64_t frame) const { return static_cast<double>(frame) * period_; }
    /// Returns when the next frame begins at the earliest [ns].
    [[nodiscard]] std::int64_t next() const { return start_ + periodNs(); }
    /// Begins the next frame at the time `now` [ns]. Returns for how long to wait before [ns], 0 if it is due. A frame
    /// that is late does not delay those after it; after more than a period they go by a new grid.
    [[nodiscard]] std::int64_t begin(std::int64_t now) {
        start_ = std::max(next(), now - periodNs());
        return std::max<std::int64_t>(start_ - now, 0);
    }

private:
    [[nodiscard]] std::int64_t periodNs() const { return static_cast<std::int64_t>(1e9 * period_); }

    double period_;           // [s]
    std::int64_t start_ = 0;  // [ns], of the frame before
};

}  // namespace master
