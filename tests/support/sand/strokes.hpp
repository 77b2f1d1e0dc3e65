// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sand/model/height_field.hpp"

/// Comparison of strokes into sand that was level at height 0.
namespace samples {

/// Returns the sum of |height - other height| over the sum of |other height|.
inline double apart(const sand::HeightField& field, const sand::HeightField& other) {
    double apart = 0, moved = 0;
    for (int y = 0; y < field.rows(); ++y) {
        for (int x = 0; x < field.columns(); ++x) {
            apart += std::abs(static_cast<double>(field.height(x, y)) - other.height(x, y));
            moved += std::abs(static_cast<double>(other.height(x, y)));
        }
    }
    return apart / moved;
}

/// Returns the highest sand [cell].
inline double highest(const sand::HeightField& field) {
    std::int32_t highest = -sand::kMaxHeight;
    for (int y = 0; y < field.rows(); ++y) {
        highest = std::max(highest, *std::max_element(field.row(y), field.row(y) + field.columns()));
    }
    return static_cast<double>(highest) / sand::kUnitsPerCell;
}

}  // namespace samples
