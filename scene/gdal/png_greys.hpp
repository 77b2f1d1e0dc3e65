// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <functional>
#include <span>
#include <string>

namespace scene {

/// Reads the grey channel of a PNG as the file holds it, in numbers of 1 to 16 bits. Calls `take` with each row from
/// the north, whose numbers it may change. Only the pixels of an interlaced picture are held in memory.
///
/// GDAL 3.6.2 swaps the two bytes of each number in an interlaced picture of 16 bits, so that its numbers are not used.
/// Throws base::InputError, whose message begins with the file, if the picture is damaged, coloured, or has another
/// size.
void readGreysOfPng(const std::string& file, int columns, int rows,
                    const std::function<void(int row, std::span<double> greys)>& take);

}  // namespace scene
