// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

/// The meaning of the fields of a file of points: of numbers, and of the names of columns.
namespace scene {

/// Returns the values of a line. Commas separate them, unless a semicolon does, or unless blanks do between numbers
/// with decimal commas.
[[nodiscard]] std::vector<std::string_view> pointFieldsOf(std::string_view text);

/// Returns whether a field means a number, even if it is mistyped, in quotes, or not finite. A measured value must not
/// pass for a name.
[[nodiscard]] bool meansNumber(std::string_view field);
/// Returns whether a value is an angle as people write it: "47.1°", "47°06'30\"", "10.2E".
[[nodiscard]] bool isAngle(std::string_view field);

/// Return whether the name of a column means the latitude, or any degrees.
[[nodiscard]] bool isLatitude(std::string_view name);
[[nodiscard]] bool isDegrees(std::string_view name);
/// Returns the axes that a column's name can mean: 0 for east, 1 for north, 2 for up. x and y are east and north as in
/// mathematics and maps, and not as in the grids of some surveyors.
[[nodiscard]] std::vector<std::size_t> axesOf(std::string_view name);
/// Returns whether a name has one of the letters x, y and z as a word: "x", "POINT_X", "y [m]".
[[nodiscard]] bool isLettered(std::string_view name);

}  // namespace scene
