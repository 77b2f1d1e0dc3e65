// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sand/model/height_field.hpp"

namespace sand::grid {

/// Field of transverse dunes. They have long windward slopes in the west and steep lee sides; their crests wind and
/// fade.
struct Dunes {
    double bed = 0;        // height of the ground between the dunes [scene unit]
    double height = 0.04;  // height of the highest crest above the bed [scene unit]
    double length = 0.4;   // distance from crest to crest [scene unit]
    std::uint32_t seed = 1;
};

/// Fills `field` with dunes. Uses only + - * /, so that every machine computes the same dunes.
void makeDunes(const Dunes& dunes, HeightField& field);

}  // namespace sand::grid
