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

/// Returns one line for each process of a session of this scene. A line has "server", "master" or a rank, and four
/// numbers [byte]. They are the memory at rest, at the peak of the start and with all sand moving, and the shared part.
/// Processes of one kind on a host have the shared part once. Launchers read these lines.
///
/// Reads no pixels: edges without data count, although a session cuts them off. Returns no lines for a terrain of
/// points. Without `checkpoints`, the master writes none. Throws base::InputError.
[[nodiscard]] std::string memoryLines(const std::string& scene, const Wall& wall, bool checkpoints);

}  // namespace walls
