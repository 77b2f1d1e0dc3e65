// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/guards/velocity_window.hpp"

#include <algorithm>
#include <cmath>

namespace haptic_bridge {

using sand::force::Vec3;

Vec3 VelocityWindow::add(double time, Vec3 place) {
    if (count_ > 0 && !(time > reading(0).time)) {
        restart();
    }
    newest_ = (newest_ + 1) % kKept;
    readings_[static_cast<std::size_t>(newest_)] = {time, place};
    count_ = std::min(count_ + 1, kKept);
    return {slope(&Vec3::x), slope(&Vec3::y), slope(&Vec3::z)};
}

double VelocityWindow::slope(double Vec3::*axis) const {
    const double now = reading(0).place.*axis, time = reading(0).time;
    double result = 0;
    for (int length = 1; length < count_; ++length) {
        const Reading& end = reading(length);
        const double candidate = (now - end.place.*axis) / (time - end.time);
        for (int ago = 1; ago < length; ++ago) {
            const Reading& between = reading(ago);
            if (!(std::abs(between.place.*axis - (now - candidate * (time - between.time))) <= resolution_)) {
                return result;
            }
        }
        result = candidate;
    }
    return result;
}

}  // namespace haptic_bridge
