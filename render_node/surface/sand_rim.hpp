// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace render_node {

/// Edge of a field, where its sand is cut.
struct SandRim {
    /// Vertices of the southern, eastern, northern and western side [scene unit], counter-clockwise from the south-west
    /// corner. Each corner is in both of its sides.
    std::array<std::vector<glm::vec3>, 4> sides;

    [[nodiscard]] float width() const { return sides[0].back().x; }
    [[nodiscard]] float depth() const { return sides[1].back().y; }
};

}  // namespace render_node
