// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sand/model/units.hpp"

namespace sand {

/// Position of the tool's centre in whole probe units [probe unit = cellSize / 256].
///
/// x runs east and y north from the south-west corner of the field; z runs up from height 0.
struct ProbePoint {
    std::int32_t x = 0, y = 0, z = 0;
    friend bool operator==(const ProbePoint&, const ProbePoint&) = default;
};

/// Largest magnitude of a probe coordinate [probe unit], four times the longest field.
inline constexpr std::int32_t kMaxProbe = 1 << 24;

/// Returns `cells` [cell] in whole probe units: the nearest number, the upper one of two, within [-kMaxProbe,
/// kMaxProbe). `cells` must not be NaN.
[[nodiscard]] inline std::int32_t probeCoordinate(double cells) {
    constexpr double kFarthest = kMaxProbe;
    return static_cast<std::int32_t>(std::floor(std::clamp(cells * kProbePerCell, -kFarthest, kFarthest - 1) + 0.5));
}

/// Returns the distance between two probe points along the axis along which they are farthest apart [probe unit].
[[nodiscard]] inline std::int64_t distanceAlongAxis(const ProbePoint& from, const ProbePoint& to) {
    const auto distance = [](std::int64_t a, std::int64_t b) { return a < b ? b - a : a - b; };
    return std::max({distance(from.x, to.x), distance(from.y, to.y), distance(from.z, to.z)});
}

/// Returns the number of sub-steps in which a tool moves from one probe point to another: at most `length` each along
/// every axis, and at least one.
[[nodiscard]] inline std::int64_t substepsBetween(const ProbePoint& from, const ProbePoint& to,
                                                  std::int32_t length = kProbePerCell /* [probe unit] */) {
    return std::max<std::int64_t>((distanceAlongAxis(from, to) + length - 1) / length, 1);
}

/// Returns the probe point of a place [cell]. All code that quantises a place uses it.
[[nodiscard]] inline ProbePoint probePoint(double x, double y, double z) {
    return {probeCoordinate(x), probeCoordinate(y), probeCoordinate(z)};
}

}  // namespace sand
