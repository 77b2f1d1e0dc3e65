// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sand/model/height_field.hpp"

namespace samples {

/// Adds `units` of sand to the square of cells within `reach` of (column, row), evenly and exactly.
inline void pour(sand::HeightField& field, int column, int row, int reach, std::int64_t units) {
    std::int64_t cells = (2 * reach + 1) * (2 * reach + 1);
    for (int y = row - reach; y <= row + reach; ++y) {
        for (int x = column - reach; x <= column + reach; ++x) {
            const std::int64_t share = units / cells--;
            units -= share;
            field.setHeight(x, y, field.height(x, y) + static_cast<std::int32_t>(share));
        }
    }
}

}  // namespace samples
