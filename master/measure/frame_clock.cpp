// SPDX-License-Identifier: Apache-2.0
#include "master/measure/frame_clock.hpp"

#include <algorithm>

namespace master {

std::int64_t FrameClock::begin(std::int64_t now, bool held) {
    if (atOnce(held)) {
        return 0;
    }
    start_ = std::max(next(held), now - periodNs());
    return std::max<std::int64_t>(start_ - now, 0);
}

Swap FrameClock::swapped(std::int64_t now) {
    const Swap swap{now, last_ == 0 ? 0 : now - last_, last_ == 0};
    if (swap.first) {
        first_ = now;
    }
    last_ = now;
    return swap;
}

double FrameClock::sinceSwap(std::int64_t now) const {
    return last_ == 0 ? 0 : static_cast<double>(now - last_) * 1e-9;
}

double FrameClock::timeOf(std::uint64_t frame, std::int64_t now) const {
    if (pace_ == haptic_bridge::Pace::fast) {
        return static_cast<double>(frame) * period_;
    }
    return last_ == 0 ? 0 : static_cast<double>(now - first_) * 1e-9;
}

}  // namespace master
