// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "scene/import/esri_grid.hpp"

namespace scene {

/// Returns whether a height is the number `noData` with which its file marks cells without data. Both are compared as
/// 32-bit floats, which most programs hold and print with different digits: -9999.9 is also -9999.900391.
[[nodiscard]] bool meansNoData(double height, double noData);

/// Returns whether many programs use `number` for "no data", such as -9999.
[[nodiscard]] bool isUsualNoData(double number);

/// Returns a warning for each such number that a raster has as a height and does not declare as no data. A warning
/// names the file, the number, and how many cells have it. It ends with `how`, the way to declare it, in which {0}
/// stands for the number. Throws base::InputError if a height is the lowest or largest float, or Surfer's blank, which
/// cannot be heights.
[[nodiscard]] std::vector<std::string> undeclaredNoData(const EsriGrid& grid, const std::string& how);
/// Returns a warning for each such number among the heights of points from `file`.
[[nodiscard]] std::vector<std::string> undeclaredNoData(const std::vector<std::array<double, 3>>& points,
                                                        const std::string& file);

}  // namespace scene
