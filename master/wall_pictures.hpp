// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "lockstep/cluster.hpp"
#include "lockstep/watchdog.hpp"
#include "walls/wall.hpp"

namespace master {

/// Receives every tile's pictures and writes them as tile_NAME_EYE.png, and the wall put together from them:
/// wall_left.png, wall_right.png and wall_anaglyph.png, or wall.png where it is mono. Progress goes to stdout.
/// The ranks must be sending; the watchdog limits the wait for each picture. Throws files::InputError when a file
/// cannot be written, after all were received.
void writeWallPictures(const lockstep::Cluster& cluster, const walls::Wall& wall, const std::filesystem::path& folder,
                       lockstep::Watchdog& watchdog);

}  // namespace master
