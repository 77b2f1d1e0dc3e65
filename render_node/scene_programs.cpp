// SPDX-License-Identifier: Apache-2.0
#include "render_node/scene_programs.hpp"

namespace render_node {

ScenePrograms::ScenePrograms(bool flatShading)
    : surface_(flatShading ? SurfaceShaders{"facet.vert.glsl", "facet.geom.glsl"} : SurfaceShaders{"sand.vert.glsl"}),
      sunlit_(surface_, "sunlit.glsl", "ball.glsl"),
      wood_("solid.vert.glsl", "wood.frag.glsl"),
      tool_("solid.vert.glsl", "tool.frag.glsl") {}

const SandPrograms& ScenePrograms::sand(bool ball, bool hillShade) {
    if (ball && !hillShade) {
        return sunlit_;
    }
    std::optional<SandPrograms>& programs = ball ? hillShaded_ : hillShade ? stampHillShaded_ : stampSunlit_;
    if (!programs) {
        programs.emplace(surface_, hillShade ? "hill_shade.glsl" : "sunlit.glsl", ball ? "ball.glsl" : "stamp.glsl");
    }
    return *programs;
}

const GlProgram& ScenePrograms::wood(bool ball) {
    if (ball) {
        return wood_;
    }
    if (!stampWood_) {
        stampWood_.emplace(ProgramFiles{"solid.vert.glsl", "wood.frag.glsl", {}, {}, "stamp.glsl"});
    }
    return *stampWood_;
}

const GlProgram& ScenePrograms::wires() {
    if (!wires_) {
        wires_.emplace(ProgramFiles{"sand.vert.glsl", "wire.frag.glsl", "sunlit.glsl", "wire.geom.glsl"});
    }
    return *wires_;
}

}  // namespace render_node
