// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sand/model/height_field.hpp"

namespace sand::grid {

/// A field of transverse dunes: long windward slopes from the west, steep lee sides, crests that wind and fade.
struct Dunes {
    double bed = 0;        // [scene unit], the ground between the dunes
    double height = 0.04;  // [scene unit], of the highest crest over the bed
    double length = 0.4;   // [scene unit], from crest to crest
    std::uint32_t seed = 1;
};

/// Fills the field. Uses + - * / only, so that every machine gets the same dunes.
void makeDunes(const Dunes& dunes, HeightField& field);

}  // namespace sand::grid
