// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "lockstep/cluster.hpp"
#include "lockstep/watchdog.hpp"
#include "pictures/image.hpp"
#include "walls/wall.hpp"

namespace master {

/// Whether one picture can hold the whole wall.
[[nodiscard]] bool fitsOnePicture(const walls::Wall& wall);

/// Receives every tile's pictures and puts each eye's together to one of the whole wall, in the order of
/// walls::eyesOf; to empty ones when they do not fit. `each`, where there is one, sees them one by one: the tile, the
/// eye's name or "output", and the picture. The ranks must be sending; the watchdog limits the wait for each picture.
[[nodiscard]] std::vector<pictures::Image> receiveWall(
    const lockstep::Cluster& cluster, const walls::Wall& wall, lockstep::Watchdog& watchdog,
    const std::function<void(const walls::Tile&, std::string_view, const pictures::Image&)>& each);

/// Receives every tile's pictures and writes them as tile_NAME_EYE.png, and the wall put together from them:
/// wall_left.png, wall_right.png and wall_anaglyph.png, or wall.png where it is mono. Progress goes to stdout.
/// The ranks must be sending; the watchdog limits the wait for each picture. Throws base::InputError when a file
/// cannot be written, after all were received.
void writeWallPictures(const lockstep::Cluster& cluster, const walls::Wall& wall, const std::filesystem::path& folder,
                       lockstep::Watchdog& watchdog);

/// The same pictures, received and not yet written.
struct HeldPictures {
    struct Tile {
        std::string file;
        pictures::Image image;
    };
    std::vector<Tile> tiles;
    std::vector<pictures::Image> whole;  // by eye; empty ones where no picture holds the wall
};
/// Whether they may be held: on a wall of more than that they are to be written one by one.
[[nodiscard]] bool mayBeHeld(const walls::Wall& wall);
[[nodiscard]] HeldPictures holdWallPictures(const lockstep::Cluster& cluster, const walls::Wall& wall,
                                            lockstep::Watchdog& watchdog);
/// Any thread. Throws base::InputError when a file cannot be written, after all were tried.
void writeHeldPictures(const HeldPictures& held, const std::filesystem::path& folder);

}  // namespace master
