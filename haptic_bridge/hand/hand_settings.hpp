// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "sand/force/vec3.hpp"

namespace haptic_bridge {

/// How a device's numbers become a place over the sand: the --map options (docs/devices.md).
struct HandSettings {
    /// One axis of the hand: a trace's column (0 to 2) with a sign.
    struct Axis {
        int column = 0;
        double sign = 1;
    };
    enum class Engage { near, always, button };  // near: the underside is lower than one radius over the surface
    enum class Datum { surface, level };  // heights count from the starting surface below the hand, or from its mean

    std::array<std::string, 4> columns{"time", "x", "y", "z"};
    double secondsPerTick = 1;                                     // of numeric times
    std::array<Axis, 3> axes{Axis{0, 1}, Axis{1, 1}, Axis{2, 1}};  // east, north, up
    std::optional<double> scale;              // [scene unit per unit of the trace]; nothing: fit 80 % of the field
    double verticalScale = 1;                 // of the vertical, relative to scale
    std::optional<sand::force::Vec3> origin;  // [unit of the trace], east, north, up: over the field's centre; else the
                                              // centre of the bounding box and the median height
    // [tool radius], of the underside, under the surface at the origin's height; nothing: 0.5 for a recording, 0 for an
    // arm
    std::optional<double> depth;
    double drift = 0;              // [reach per reach moved], of an arm's workspace to where the hand works
    std::optional<Engage> engage;  // nothing: near for a recording, always for an arm
    std::optional<Datum> datum;    // nothing: surface for what has no body, level for an arm

    /// Reads KEY=VALUE texts. Throws base::InputError that names option, key and the keys there are.
    static HandSettings parse(const std::vector<std::string>& options);
};

}  // namespace haptic_bridge
