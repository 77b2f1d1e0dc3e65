// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace shapes {

/// Edges where the sand is cut: the field's edge, and the outline of ground without data.
struct SandRim {
    glm::vec2 field{0};  // [scene unit], width and depth
    /// Lines along the edges [scene unit]. Seen from above, the sand is on their left.
    std::vector<std::vector<glm::vec3>> cuts;
    bool hasHoles = false;  // whether a part of the field has no ground
};

}  // namespace shapes
