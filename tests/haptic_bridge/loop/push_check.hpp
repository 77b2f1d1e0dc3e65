// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "haptic_bridge/loop/guards/force_limits.hpp"
#include "sand/force/vec3.hpp"

namespace test {

/// Checks every push of an arm against the bounds of docs/forces.md. It shares no code with the guards.
class PushCheck {
public:
    explicit PushCheck(const haptic_bridge::ForceLimits& limits) : maxForce_(limits.maxForce), slew_(limits.slew) {}

    /// Returns what is wrong with the next push; empty if it keeps all bounds.
    [[nodiscard]] std::string wrong(sand::force::Vec3 now) {
        const sand::force::Vec3 before = last_;
        last_ = now;
        const double size = std::sqrt(now.x * now.x + now.y * now.y + now.z * now.z);
        if (!std::isfinite(size)) {
            return "it is not finite";
        }
        if (size > maxForce_ * (1 + 1e-9)) {
            return fmt::format("{} N are more than the device's {} N", size, maxForce_);
        }
        const double turned = fromShortened(before, now);
        if (turned > 1.5 * slew_ * (1 + 1e-9) + 1e-12) {
            return fmt::format("it grows or turns by {} N, more than 1.5 times {} N", turned, slew_);
        }
        return {};
    }
    void restart() { last_ = {}; }

private:
    /// Returns the distance of `now` from the nearest force that `before` may fall to.
    static double fromShortened(sand::force::Vec3 before, sand::force::Vec3 now) {
        const double square = before.x * before.x + before.y * before.y + before.z * before.z;
        const double part = square > 0 ? (before.x * now.x + before.y * now.y + before.z * now.z) / square : 0;
        const double kept = part < 0 ? 0 : part > 1 ? 1 : part;
        return std::sqrt(std::pow(now.x - kept * before.x, 2) + std::pow(now.y - kept * before.y, 2) +
                         std::pow(now.z - kept * before.z, 2));
    }

    double maxForce_, slew_;
    sand::force::Vec3 last_;
};

}  // namespace test
