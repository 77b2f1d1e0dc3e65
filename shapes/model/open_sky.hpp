// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <span>

namespace shapes {

struct SkyDirection {
    int east, north;
    float length;
};
inline constexpr float kSkyDiagonal = 1.41421356F;
inline constexpr std::array<SkyDirection, 8> kSkyDirections{{{1, 0, 1},
                                                             {-1, 0, 1},
                                                             {0, 1, 1},
                                                             {0, -1, 1},
                                                             {1, 1, kSkyDiagonal},
                                                             {-1, 1, kSkyDiagonal},
                                                             {1, -1, kSkyDiagonal},
                                                             {-1, -1, kSkyDiagonal}}};
/// Distances at which the horizon of a place is sampled [cell].
inline constexpr std::array<int, 3> kSkyDistances{2, 5, 10};

/// Computes the sky's light on level ground for neighbouring places: one minus the mean squared sine of the horizon in
/// eight directions.
///
/// `rise(place, east, north)` returns how much higher the sand is, so many cells to the east and north [scene unit].
/// The loop handles all places for one direction before the next direction, so that the compiler computes several
/// places at a time.
template <class Rise>
void openSky(std::span<float> open, float cellSize, const Rise& rise) {
    std::fill(open.begin(), open.end(), 0.0F);
    for (const SkyDirection& direction : kSkyDirections) {
        for (std::size_t place = 0; place < open.size(); ++place) {
            float steepest = 0;
            for (const int distance : kSkyDistances) {
                const float there = rise(place, direction.east * distance, direction.north * distance);
                steepest = std::max(steepest, there / (direction.length * static_cast<float>(distance)));
            }
            const float square = steepest / cellSize * (steepest / cellSize);
            open[place] += square / (1 + square);
        }
    }
    for (float& place : open) {
        place = 1 - place / static_cast<float>(kSkyDirections.size());
    }
}

}  // namespace shapes
