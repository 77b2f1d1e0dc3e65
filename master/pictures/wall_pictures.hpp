// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "lockstep/frame_barrier.hpp"
#include "pictures/image.hpp"
#include "walls/wall.hpp"

namespace master {

/// Returns whether one picture can hold the whole wall.
[[nodiscard]] bool fitsOnePicture(const walls::Wall& wall);

/// Receives the pictures of all tiles. Returns one picture of the whole wall per eye, in the order of walls::eyesOf().
/// These pictures are empty if fitsOnePicture() is false. If `each` is set, calls it for every received picture with
/// the tile, the eye's name or "output", and the picture. The ranks must be sending. The watchdog limits the wait for
/// each picture.
[[nodiscard]] std::vector<pictures::Image> receiveWall(
    lockstep::FrameBarrier& barrier, const walls::Wall& wall,
    const std::function<void(const walls::Tile&, std::string_view, const pictures::Image&)>& each);

/// Receives the pictures of all tiles and writes them as tile_NAME_EYE.png. Also writes pictures of the whole wall:
/// wall_left.png, wall_right.png and wall_anaglyph.png, or wall.png if the wall draws one eye. Prints progress on
/// standard output. The ranks must be sending. The watchdog limits the wait for each picture. Throws base::InputError
/// if a file cannot be written, after all pictures were received.
void writeWallPictures(lockstep::FrameBarrier& barrier, const walls::Wall& wall, const std::filesystem::path& folder);

/// The pictures of all tiles and of the whole wall, received and not yet written.
struct HeldPictures {
    struct Tile {
        std::string file;
        pictures::Image image;
    };
    std::vector<Tile> tiles;
    std::vector<pictures::Image> whole;  // one per eye; empty if fitsOnePicture() is false
};
/// Returns whether all pictures of the wall may be held in memory. The pictures of a larger wall are written one by
/// one.
[[nodiscard]] bool mayBeHeld(const walls::Wall& wall);
[[nodiscard]] HeldPictures holdWallPictures(lockstep::FrameBarrier& barrier, const walls::Wall& wall);
/// Writes the pictures. Throws base::InputError if a file cannot be written, after all files were tried. Any thread.
void writeHeldPictures(const HeldPictures& held, const std::filesystem::path& folder);

}  // namespace master
