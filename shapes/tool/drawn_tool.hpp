// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "sand/model/tool.hpp"

namespace shapes {

/// A tool at its place, as it is drawn.
struct DrawnTool {
    sand::Tool tool;
    glm::vec3 place;   // [scene unit], of the centre
    float radius = 0;  // [scene unit]; a tool of radius 0 is not drawn
    bool engaged = false;

    [[nodiscard]] bool isBall() const { return tool.kind == sand::ToolKind::sphere; }
    friend bool operator==(const DrawnTool&, const DrawnTool&) = default;
};

}  // namespace shapes
