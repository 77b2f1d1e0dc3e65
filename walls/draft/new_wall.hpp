// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace walls {

/// Writes a wall file of a grid of displays, with values to be changed to those of a real wall: displays of 55 inches
/// without stereo, the sand on a table before the viewer. `grid` is ROWSxCOLUMNS, such as "2x2". Never replaces a file.
/// Throws base::InputError about the text of `grid`, or about `file`.
void writeNewWall(const std::filesystem::path& file, const std::string& grid);

}  // namespace walls
