// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"
#include "sand/tin/geometry/tin_start.hpp"

namespace sand {

/// What a replica starts with. Equal starts and equal steps make equal sand.
struct Start {
    Rules rules;
    HeightField terrain{1, 1, 1.0};            // of a TIN one cell, for its nominal size
    std::shared_ptr<const tin::TinStart> tin;  // null for a height field
    std::shared_ptr<const Ground> ground;      // null without rock and walls

    [[nodiscard]] double toolRadius() const {  // [scene unit]
        return rules.toolRadius * terrain.cellSize() / kProbePerCell;
    }
    /// Begins as this TIN, in place of whatever it began as; keeps the cell size.
    void beginAs(tin::TinStart start);
    /// The mean height [unit]: devices hover and dig relative to it.
    [[nodiscard]] std::int32_t referenceHeight() const;
};

}  // namespace sand
