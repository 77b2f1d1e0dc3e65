// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/model/height_field.hpp"

namespace samples {

/// Puts a rectangle onto a grid in one of eight ways. Bit 0 mirrors east and west, bit 1 mirrors north and south, and
/// bit 2 then exchanges columns and rows.
inline sand::HeightField turned(const sand::HeightField& field, unsigned way) {
    const bool transposed = (way & 4) != 0;
    sand::HeightField result(transposed ? field.rows() : field.columns(), transposed ? field.columns() : field.rows(),
                             1.0);
    for (int y = 0; y < field.rows(); ++y) {
        for (int x = 0; x < field.columns(); ++x) {
            const int toX = (way & 1) != 0 ? field.columns() - 1 - x : x;
            const int toY = (way & 2) != 0 ? field.rows() - 1 - y : y;
            result.setHeight(transposed ? toY : toX, transposed ? toX : toY, field.height(x, y));
        }
    }
    return result;
}

}  // namespace samples
