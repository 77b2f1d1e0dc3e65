// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "lockstep/frame_barrier.hpp"

namespace lockstep {

/// Picture of one tile for one eye, or of its output: RGB, 8 bits per channel, rows from the top, no padding.
struct TilePicture {
    int rank = 0;
    // Index among the eyes that the tile draws. For the output picture, which is made of all eyes: their number.
    int eye = 0;
    int width = 0, height = 0;
    std::vector<std::uint8_t> pixels;
};

/// Sends one picture from a render rank to the master, which must be in receivePictures(). The caller's watchdog must
/// be armed.
void sendPicture(const Cluster& cluster, const TilePicture& picture);

/// Receives pictures at the master, in order of rank and eye, and passes each to `take`. `eyesByRank` is the number of
/// pictures of each rank. Only one picture is in memory at a time, however large the wall is. The watchdog of `barrier`
/// limits the wait for each picture, and names its rank.
void receivePictures(FrameBarrier& barrier, const std::vector<int>& eyesByRank,
                     const std::function<void(const TilePicture&)>& take);

}  // namespace lockstep
