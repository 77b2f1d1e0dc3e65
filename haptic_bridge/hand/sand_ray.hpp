// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "sand/force/vec3.hpp"

namespace haptic_bridge {

/// Line of sight through a pointer.
struct Ray {
    sand::force::Vec3 from;
    sand::force::Vec3 along{0, 0, -1};  // need not be a unit vector
};

/// A place of a field, seen from above.
struct FieldPlace {
    double x = 0, y = 0;
};

/// Sand as a ray meets it. All numbers have the same unit of length, such as cells.
struct SandBody {
    double width = 0, depth = 0;     // size of the field, which begins at (0, 0)
    double lowest = 0, highest = 0;  // no height is outside of these
    double step = 0.5;               // longest distance, seen from above, of two places at which heights are compared
    std::function<double(double x, double y)> height;
};

/// Returns the first place at which the ray is at or below the sand's surface. Returns nullopt if it passes beside the
/// sand, meets the box of sand from its side or from below, or points away. The place is exact to a hundredth of a
/// step.
[[nodiscard]] std::optional<FieldPlace> meetSand(const Ray& ray, const SandBody& sand);

}  // namespace haptic_bridge
