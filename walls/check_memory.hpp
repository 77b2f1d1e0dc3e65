// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <string>

#include "scene/model/session_memory.hpp"
#include "walls/wall.hpp"

namespace walls {

/// Returns a table for a person: the memory of each kind of process of a session on this sand. With a `wall`, also that
/// of each of its hosts. If `wall` is null, a rank has the picture of the desktop wall.
[[nodiscard]] std::string memoryTable(const scene::SandSize& sand, const Wall* wall);

/// Returns one line for each process of a session of this scene. A line has "server", "master" or a rank, and four
/// numbers [byte]. They are the memory at rest, at the peak of the start and with all sand moving, and the shared part.
/// Processes of one kind on a host have the shared part once. Launchers read these lines.
///
/// Reads no pixels: edges without data count, although a session cuts them off. Returns no lines for a terrain of
/// points. Without `checkpoints`, the master writes none. Throws base::InputError.
[[nodiscard]] std::string memoryLines(const std::string& scene, const Wall& wall, bool checkpoints);

}  // namespace walls
