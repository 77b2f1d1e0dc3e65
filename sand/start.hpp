// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"
#include "sand/tin/geometry/tin_start.hpp"

namespace sand {

/// Rules, sand and ground that a replica begins with. Equal starts and equal steps make equal sand.
struct Start {
    Rules rules;
    HeightField terrain{1, 1, 1.0};            // for a TIN one cell, which gives the nominal cell size
    std::shared_ptr<const tin::TinStart> tin;  // null for a height field
    std::shared_ptr<const Ground> ground;      // null without rock and wall cells

    [[nodiscard]] double toolRadius() const {  // [scene unit]
        return rules.tuning.tool.radius * terrain.cellSize() / kProbePerCell;
    }
    /// Makes the TIN `start` the sand that a replica begins with. Sets `tin`, `terrain` and `rules.tin`; keeps the cell
    /// size.
    void beginAs(tin::TinStart start);
    /// Returns the mean height of the sand as a whole number [unit]. Devices hover and dig relative to it.
    [[nodiscard]] std::int32_t referenceHeight() const;
};

}  // namespace sand
