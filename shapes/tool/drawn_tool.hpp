// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "sand/model/probe_point.hpp"
#include "sand/model/tool.hpp"
#include "sand/model/units.hpp"

namespace shapes {

/// A tool at its place, as it is drawn.
struct DrawnTool {
    sand::Tool tool;
    glm::vec3 place;   // [scene unit], of the centre
    float radius = 0;  // [scene unit]; a tool of radius 0 is not drawn
    bool engaged = false;

    /// Returns a tool whose centre is at `probe`, on sand whose cells have the side `cellSize` [scene unit].
    [[nodiscard]] static DrawnTool at(const sand::Tool& tool, const sand::ProbePoint& probe, bool engaged,
                                      double cellSize) {
        const glm::dvec3 place = glm::dvec3(probe.x, probe.y, probe.z) * sand::probeUnit(static_cast<float>(cellSize));
        return {tool, glm::vec3(place), radiusOf(tool, cellSize), engaged};
    }
    [[nodiscard]] static float radiusOf(const sand::Tool& tool, double cellSize) {
        return static_cast<float>(tool.radius * sand::probeUnit(cellSize));
    }
    [[nodiscard]] bool isBall() const { return tool.kind == sand::ToolKind::sphere; }
    friend bool operator==(const DrawnTool&, const DrawnTool&) = default;
};

}  // namespace shapes
