// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "lockstep/cluster.hpp"

namespace lockstep {

/// One eye's picture of one tile, or its output's: RGB, 8 bits a channel, rows from the top, no padding.
struct TilePicture {
    int rank = 0;
    int eye = 0;  // index among the eyes the tile draws; their number for the output that is made of them
    int width = 0, height = 0;
    std::vector<std::uint8_t> pixels;
};

/// At a render rank: hands one picture to the master, which must be receiving.
void sendPicture(const Cluster& cluster, const TilePicture& picture);

/// At the master: receives `count` pictures in the order of ranks and eyes. One picture at a time is in memory here,
/// however large the wall.
void receivePictures(const Cluster& cluster, const std::vector<int>& eyesByRank,
                     const std::function<void(const TilePicture&)>& take);

}  // namespace lockstep
