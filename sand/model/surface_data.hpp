// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"

namespace sand {

namespace tin {
struct SurfaceView;
}

/// Sand as a height field.
struct GridData {
    const HeightField& field;
    const Ground* ground = nullptr;  // null without rock and walls
};

/// Sand as a TIN.
struct TinData {
    const tin::SurfaceView& view;
};

/// The sand itself, as drawing, forces and exports read it: the one type that tells a height field from a TIN.
/// tests/scripts/kinds_of_sand_test.py counts the places that ask which of the two it is.
using SurfaceData = std::variant<GridData, TinData>;

/// Runs of blocks in which cells changed: disjoint, row by row from the south-west. Blocks are 8 × 8 cells.
struct CellChange {
    std::vector<CellRect> cells;
};

struct TinChange {
    std::vector<std::int32_t> triangles;  // slots whose corners or constraints changed, or that came or went, ascending
    std::vector<std::int32_t> vertices;   // that came, went, rose or sank, ascending
};

/// Difference of a surface from the last Surface::takeChange().
struct SurfaceChange {
    bool whole = true;                          // everything may differ, whatever `parts` holds
    std::variant<CellChange, TinChange> parts;  // of the same kind as the surface's data
};

}  // namespace sand
