// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "sand/model/height_field.hpp"

namespace oracles {

/// Returns how far a field at rest is outside the envelopes of its start [threshold]. The lower envelope is the minimum
/// of all slopes at the talus that rise from a cell of the start. The upper envelope is the maximum of all slopes at
/// the talus that fall from a cell. A negative result is a distance inside.
inline double outsideEnvelopes(const sand::HeightField& start, const sand::HeightField& rest) {
    double outside = -1e300;
    for (int y = 0; y < rest.rows(); ++y) {
        for (int x = 0; x < rest.columns(); ++x) {
            double lower = 1e300;
            double upper = -1e300;
            for (int fromY = 0; fromY < start.rows(); ++fromY) {
                for (int fromX = 0; fromX < start.columns(); ++fromX) {
                    const double fall = sand::kUnitsPerCell * std::hypot(x - fromX, y - fromY);
                    lower = std::min(lower, start.height(fromX, fromY) + fall);
                    upper = std::max(upper, start.height(fromX, fromY) - fall);
                }
            }
            outside = std::max({outside, lower - rest.height(x, y), rest.height(x, y) - upper});
        }
    }
    return outside / sand::kUnitsPerCell;
}

}  // namespace oracles
