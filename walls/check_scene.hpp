// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <string>

#include "walls/wall.hpp"

namespace walls {

/// Loads a scene file and returns lines about it: its size, the units and no data of its files of terrain, its
/// warnings, the cost of its tools, and the memory and the start of a session on `wall`. `wall` may be null. Throws
/// base::InputError if a session could not load it.
[[nodiscard]] std::string describeScene(const std::string& file, const Wall* wall);

/// Loads a scene file and returns a line for programs: columns, rows and cell size [scene unit]. Measures no time.
/// Throws base::InputError if a session could not load it.
[[nodiscard]] std::string cellsOfScene(const std::string& file);

}  // namespace walls
