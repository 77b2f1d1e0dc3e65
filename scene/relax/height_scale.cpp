// SPDX-License-Identifier: Apache-2.0
#include "scene/relax/height_scale.hpp"

#include <cmath>

#include "sand/model/height_field.hpp"

namespace scene::relax {

std::int32_t HeightScale::toUnits(double height) const {
    return static_cast<std::int32_t>(std::floor((height - datum) / unit + 0.5));
}

bool HeightScale::holds(double lowest, double highest) const {
    const auto fits = [&](double height) {
        return std::abs(std::floor((height - datum) / unit + 0.5)) <= sand::kMaxHeight;
    };
    return fits(lowest) && fits(highest);
}

HeightScale HeightScale::finest(double shorterSide, double lowest, double highest) {
    const double middle = lowest / 2 + highest / 2;
    HeightScale scale{.unit = std::ldexp(shorterSide, -sand::kHeightBits), .datum = 0, .bits = sand::kHeightBits};
    for (; scale.bits >= 0; --scale.bits, scale.unit *= 2) {
        scale.datum = scale.unit * std::floor(middle / scale.unit + 0.5);
        if (scale.holds(lowest, highest)) {
            break;
        }
    }
    return scale;
}

}  // namespace scene::relax
