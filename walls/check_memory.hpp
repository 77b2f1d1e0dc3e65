// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <string>

#include "scene/model/session_memory.hpp"
#include "walls/wall.hpp"

namespace walls {

/// Returns a table for a person: the memory of each kind of process in a session on sand of this size, and of each host
/// of the wall, unless `wall` is null. Without a wall, a rank has the picture of the desktop wall.
[[nodiscard]] std::string memoryTable(const scene::SandSize& sand, const Wall* wall);

/// Returns one line for each process of a session of this scene: "server", "master" or its rank, and four numbers
/// [byte]: its memory at rest, at the peak of the start and with all sand moving, and the part of them that processes
/// of its kind on one host share. Launchers read these lines. Reads no pixels. If edges of the raster may be cut off,
/// all figures are those of reading. Returns no lines for a terrain of points. Throws base::InputError. Without
/// `checkpoints`, the master writes none.
[[nodiscard]] std::string memoryLines(const std::string& scene, const Wall& wall, bool checkpoints);

}  // namespace walls
