// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <string>
#include <vector>

namespace scene {

/// Reads the grey channel of a PNG as the file holds it: rows from the north, numbers of 1 to 16 bits.
///
/// GDAL 3.6.2 swaps the two bytes of each number in an interlaced picture of 16 bits, so that its numbers are not used.
/// Throws base::InputError, whose message begins with the file, if the picture is damaged, coloured, or has another
/// size.
[[nodiscard]] std::vector<double> greysOfPng(const std::string& file, int columns, int rows);

}  // namespace scene
