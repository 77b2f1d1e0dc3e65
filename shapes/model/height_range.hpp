// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace shapes {

struct HeightRange {
    float lowest, highest;  // [scene unit]
};

/// Returns the smallest range around both.
[[nodiscard]] inline HeightRange around(const HeightRange& a, const HeightRange& b) {
    return {std::min(a.lowest, b.lowest), std::max(a.highest, b.highest)};
}

}  // namespace shapes
