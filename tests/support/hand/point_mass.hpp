// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "sand/force/vec3.hpp"

namespace support {

/// The smallest haptic device: m x'' + b x' = u, with u held between ticks and integrated exactly.
struct PointMass {
    double mass = 0.05, damping = 0.5;  // [kg], [N · s/m]
    sand::force::Vec3 place, velocity;  // [m], [m/s]

    void push(sand::force::Vec3 force /* [N] */, double tick /* [s] */) {
        const double kept = std::exp(-damping * tick / mass);
        const sand::force::Vec3 last = (1 / damping) * force;  // the final velocity
        place = place + tick * last + (mass / damping * (1 - kept)) * (velocity - last);
        velocity = last + kept * (velocity - last);
    }
};

}  // namespace support
