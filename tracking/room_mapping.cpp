// SPDX-License-Identifier: Apache-2.0
#include "tracking/room_mapping.hpp"

#include <array>

#include "base/number.hpp"
#include "base/text.hpp"

namespace tracking {

Pose RoomMapping::pose(const Measured& measured) const {
    // A turn in mirrored axes is still a turn, so this is right for axes of either handedness.
    const glm::dmat3 head = axes * measured.rotation * glm::transpose(axes);
    return {origin + axes * measured.position + head * eyes, glm::normalize(head[0])};
}

std::optional<glm::dmat3> axesOf(std::string_view text) {
    const auto words = base::split(text, ',');
    if (words.size() != 3) {
        return std::nullopt;
    }
    glm::dmat3 axes(0.0);
    std::array<bool, 3> used{};
    for (int room = 0; room < 3; ++room) {
        std::string_view word = words[static_cast<std::size_t>(room)];
        const double sign = word.starts_with('-') ? -1 : 1;
        word.remove_prefix(word.starts_with('-') || word.starts_with('+') ? 1 : 0);
        if (word.size() != 1 || word[0] < 'x' || word[0] > 'z' || used[static_cast<std::size_t>(word[0] - 'x')]) {
            return std::nullopt;
        }
        used[static_cast<std::size_t>(word[0] - 'x')] = true;
        axes[word[0] - 'x'][room] = sign;
    }
    return axes;
}

std::optional<glm::dvec3> pointOf(std::string_view text) {
    const auto words = base::split(text, ',');
    glm::dvec3 point(0);
    if (words.size() != 3) {
        return std::nullopt;
    }
    for (int i = 0; i < 3; ++i) {
        const std::optional<double> value = base::numberOf(words[static_cast<std::size_t>(i)]);
        if (!value) {
            return std::nullopt;
        }
        point[i] = *value;
    }
    return point;
}

}  // namespace tracking
