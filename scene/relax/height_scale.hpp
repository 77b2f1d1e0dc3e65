// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace scene::relax {

/// Scale between a file's heights and whole numbers.
///
/// The unit is the shorter side of a cell divided by 2^k. The datum is a multiple of the unit. A height that is a
/// multiple of the unit therefore keeps its exact distance from all others, whatever the datum.
struct HeightScale {
    double unit = 1;   // [file's height unit]
    double datum = 0;  // height that is 0 [file's height unit]
    int bits = 0;      // k

    [[nodiscard]] std::int32_t toUnits(double height) const;
    [[nodiscard]] double toHeight(std::int32_t units) const { return datum + units * unit; }
    /// Returns whether heights from `lowest` to `highest` are within ±kMaxHeight.
    [[nodiscard]] bool holds(double lowest, double highest) const;

    /// Returns the finest scale with at most kHeightBits that holds these heights. `bits` is below 0 if no scale holds
    /// them.
    static HeightScale finest(double shorterSide, double lowest, double highest);
};

}  // namespace scene::relax
