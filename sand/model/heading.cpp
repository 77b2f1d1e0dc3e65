// SPDX-License-Identifier: Apache-2.0
#include "sand/model/heading.hpp"

#include <cmath>
#include <numbers>

namespace sand {

std::optional<Heading> headingOf(double degrees, bool mirrored) {
    if (!std::isfinite(degrees)) {
        return std::nullopt;
    }
    const double angle = std::remainder(degrees, 360) * (std::numbers::pi / 180);
    const auto rounded = [](double share) { return static_cast<std::int16_t>(std::lround(share * Heading::kLength)); };
    return Heading{rounded(std::cos(angle)), rounded(std::sin(angle)), mirrored};
}

double degreesOf(const Heading& heading) {
    return std::atan2(static_cast<double>(heading.y), static_cast<double>(heading.x)) * 180 / std::numbers::pi;
}

}  // namespace sand
