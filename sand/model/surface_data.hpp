// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/movement.hpp"

namespace sand {

namespace tin {
struct SurfaceView;
}

/// References to the sand of a height field.
struct GridData {
    const HeightField& field;
    const Ground* ground = nullptr;      // null without rock and wall cells
    const Movement* movement = nullptr;  // null if all sand counts as at rest
};

/// Reference to the sand of a TIN.
struct TinData {
    const tin::SurfaceView& view;
};

/// The sand as drawing, forces and exports read it: a height field or a TIN.
///
/// Only a few source files may ask which of the two it is; tests/scripts/checks/kinds_of_sand_test.py lists them.
using SurfaceData = std::variant<GridData, TinData>;

/// Change of a height field.
struct CellChange {
    /// Rectangles that contain all changed cells. Each is a run of blocks of 8 × 8 cells within one row of blocks, cut
    /// off at the field's border. They are disjoint and ordered row by row from the south-west.
    std::vector<CellRect> cells;
};

/// Change of a TIN.
struct TinChange {
    /// Triangles that were added or removed, or whose corners or constraints changed: slots in ascending order.
    std::vector<std::int32_t> triangles;
    /// Vertices that were added or removed, or whose height may have changed, in ascending order.
    std::vector<std::int32_t> vertices;
};

/// Change of a surface since the previous call of Surface::takeChange().
struct SurfaceChange {
    bool whole = true;  // whether everything may have changed; `parts` then has no meaning
    /// The changed parts: a CellChange of a height field, or a TinChange of a TIN.
    std::variant<CellChange, TinChange> parts;
};

}  // namespace sand
