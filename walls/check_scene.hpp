// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <string>

namespace walls {

/// Loads a scene file and returns lines about it: its size, the units and no data of its files of terrain, and its
/// warnings. Throws base::InputError if a session could not load it.
[[nodiscard]] std::string describeScene(const std::string& file);

/// Loads a scene file and returns a line for programs: columns, rows and cell size [scene unit]. Measures no time.
/// Throws base::InputError if a session could not load it.
[[nodiscard]] std::string cellsOfScene(const std::string& file);

}  // namespace walls
