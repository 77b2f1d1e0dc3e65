// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <random>
#include <vector>

#include "sand/tin/geometry/tin_start.hpp"
#include "tests/described/filler.hpp"
#include "tests/support/sand/tin_piles.hpp"
#include "walls/wall.hpp"

namespace described {

/// Returns a value of a described type with random members. For types whose members depend on each other, it is one
/// value with all parts.
template <class T>
T sampleOf(std::mt19937& random) {
    T value;
    Filler filler(random);
    T::fields(value, filler);
    return value;
}
template <>
inline sand::tin::TinStart sampleOf<sand::tin::TinStart>(std::mt19937& random) {
    sand::tin::TinStart start = tin_piles::levelStart(4, static_cast<std::uint32_t>(random()));
    start.holes = std::make_shared<const sand::tin::Holes>(sand::tin::nominalCells(start.width, start.depth),
                                                           std::vector<sand::tin::Holes::Run>{{1, 1, 3}, {2, 1, 2}});
    start.constraints = {{0, 4}, {1, 5}};
    return start;
}
template <>
inline walls::Wall sampleOf<walls::Wall>(std::mt19937& random) {
    walls::Wall wall;
    Filler filler(random);
    filler("stereo", wall.stereo);
    filler("name", base::text(wall.name, 8));
    wall.grid = walls::Grid{.rows = 1, .columns = 2};
    wall.tiles = walls::tilesOf(*wall.grid, wall.stereo);
    wall.tiles[1].outputs[0].window = {3, -4};
    return wall;
}

/// Returns the bytes of several values of a described type.
template <class T>
std::vector<base::Bytes> samplesOf(std::mt19937& random) {
    std::vector<base::Bytes> all{base::encoded(T{})};
    for (int i = 0; i < 8; ++i) {
        all.push_back(base::encoded(sampleOf<T>(random)));
    }
    return all;
}

}  // namespace described
