// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "sand/force/vec3.hpp"

namespace haptic_bridge {

/// Velocity by the first-order adaptive window (Janabi-Sharifi, Hayward and Chen 2000). Each axis is separate.
///
/// The velocity is the slope over the longest run of the latest ticks through which one straight line passes within the
/// resolution. A fast hand is noticed at once. A slow hand has less noise than in a difference over one tick.
class VelocityWindow {
public:
    static constexpr int kLongest = 15;  // [tick]

    /// `resolution` is that of a reading, in the unit of places.
    explicit VelocityWindow(double resolution) : resolution_(resolution) {}

    /// Adds a reading and returns the velocity [unit/s]; 0 at the first reading, and while the clock does not advance.
    [[nodiscard]] sand::force::Vec3 add(double time /* [s] */, sand::force::Vec3 place);
    void restart() { count_ = 0; }

private:
    static constexpr int kKept = kLongest + 1;
    struct Reading {
        double time = 0;
        sand::force::Vec3 place;
    };
    /// Returns the reading `ago` ticks before the last one.
    [[nodiscard]] const Reading& reading(int ago) const {
        return readings_[static_cast<std::size_t>((newest_ + kKept - ago) % kKept)];
    }
    [[nodiscard]] double slope(double sand::force::Vec3::*axis) const;

    double resolution_;
    std::array<Reading, kKept> readings_{};
    int newest_ = 0;
    int count_ = 0;
};

}  // namespace haptic_bridge
