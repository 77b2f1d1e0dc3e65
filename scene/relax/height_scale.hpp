// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace scene::relax {

/// Which whole numbers stand for a file's heights.
///
/// The unit is the shorter side of a cell over 2^k. The datum is a multiple of the unit, so that a height that is one
/// keeps its distance from all others whatever the datum.
struct HeightScale {
    double unit = 1;   // [file's height unit]
    double datum = 0;  // height that is 0 [file's height unit]
    int bits = 0;      // k

    [[nodiscard]] std::int32_t toUnits(double height) const;
    [[nodiscard]] double toHeight(std::int32_t units) const { return datum + units * unit; }
    /// Whether heights from `lowest` to `highest` are within ±kMaxHeight.
    [[nodiscard]] bool holds(double lowest, double highest) const;

    /// The finest scale of at most kHeightBits that holds these heights: `bits` is below 0 when there is none.
    static HeightScale finest(double shorterSide, double lowest, double highest);
};

}  // namespace scene::relax
