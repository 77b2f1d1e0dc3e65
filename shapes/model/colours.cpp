// SPDX-License-Identifier: Apache-2.0
#include "shapes/model/colours.hpp"

#include <cmath>

namespace shapes {

glm::vec3 encoded(const glm::vec3& linear) {
    const auto channel = [](float light) {
        const float level = light <= 0.0031308F ? 12.92F * light : 1.055F * std::pow(light, 1 / 2.4F) - 0.055F;
        return std::round(255 * level) / 255;
    };
    return {channel(linear.x), channel(linear.y), channel(linear.z)};
}

glm::vec3 wetAlbedo(const glm::vec3& dry, double humidity) {
    constexpr double kMostSentBack = 0.68;  // sand of the default colour is then about half as bright
    const auto share = static_cast<float>(kMostSentBack * humidity * (2 - humidity));
    return dry * (1 - share) / (1.0F - share * glm::clamp(dry, 0.0F, 1.0F));
}

}  // namespace shapes
