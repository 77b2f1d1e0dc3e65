// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <optional>
#include <string_view>

namespace scene {

/// Returns the size of a unit of length [m] by a name that GDAL's drivers, EPSG, NetCDF and users give it, in capitals
/// or not. Returns nullopt for another name.
[[nodiscard]] std::optional<double> metresOf(std::string_view unit);

/// Returns whether a name stands for no unit: empty, "unspecified", "unknown".
[[nodiscard]] bool meansNoUnit(std::string_view unit);

/// Returns whether a name is that of an angle: "degrees_east", "Degree", "radian".
[[nodiscard]] bool isAngle(std::string_view unit);

}  // namespace scene
