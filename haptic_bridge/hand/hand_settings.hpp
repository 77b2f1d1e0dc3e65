// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/names.hpp"
#include "sand/force/vec3.hpp"

namespace haptic_bridge {

/// Settings of the mapping from a device's numbers to a place over the sand: the --map options (docs/devices.md).
struct HandSettings {
    /// One axis of the hand: a column of the trace (0 to 2) and a sign.
    struct Axis {
        int column = 0;
        double sign = 1;
    };
    /// When the tool is engaged. near: while its underside is less than one radius above the surface.
    enum class Engage { near, always, button };
    /// Height 0 of the hand: the starting surface below the hand, or the mean height of that surface.
    enum class Datum { surface, level };
    friend constexpr auto valuesOf(Datum) {
        return std::array{base::Named{Datum::surface, "surface"}, base::Named{Datum::level, "level"}};
    }

    std::array<std::string, 4> columns{"time", "x", "y", "z"};
    double secondsPerTick = 1;                                     // [s], unit of times that are written as numbers
    std::array<Axis, 3> axes{Axis{0, 1}, Axis{1, 1}, Axis{2, 1}};  // east, north, up
    std::optional<double> scale;  // [scene unit per unit of the trace]; nullopt: fit 80 % of the field
    double verticalScale = 1;     // scale of the vertical, relative to `scale`
    // Place over the field's centre [unit of the trace]: east, north, up. nullopt: for a recording the centre of its
    // bounding box and its median height, for an arm the middle of its workspace.
    std::optional<sand::force::Vec3> origin;
    // Depth of the underside below the surface when the hand is at the origin's height [tool radius]. nullopt: 0.5 for
    // a recording, 0 for an arm.
    std::optional<double> depth;
    double drift = 0;  // [reach per reach moved]; moves the middle of an arm's workspace towards where the hand works
    std::optional<Engage> engage;  // nullopt: near for a recording, always for an arm
    std::optional<Datum> datum;    // nullopt: surface for a device without a body, level for an arm

    /// Reads `options`, texts of the form KEY=VALUE. Throws base::InputError that names the option and what is wrong.
    /// For an unknown key it lists all keys.
    static HandSettings parse(const std::vector<std::string>& options);
};

}  // namespace haptic_bridge
