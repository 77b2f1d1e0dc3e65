// SPDX-License-Identifier: Apache-2.0
#include "render_node/scene_programs.hpp"

namespace render_node {
namespace {

ProgramFiles filesOf(SandLight light, std::string_view vertex, std::string_view fragment, std::string_view geometry,
                     std::string_view tool = "ball.glsl") {
    return {vertex,   fragment, light == SandLight::hillShade ? "hill_shade.glsl" : "sunlit.glsl",
            geometry, tool,     light == SandLight::wet ? "sheen.glsl" : std::string_view()};
}

}  // namespace

SandPrograms::SandPrograms(const SurfaceShaders& surface, SandLight light, std::string_view tool)
    : far(filesOf(light, surface.vertex, "sand.frag.glsl", surface.geometry)),
      near(filesOf(light, surface.vertex, "near.frag.glsl", surface.geometry, tool)),
      sides(filesOf(light, "side.vert.glsl", "near.frag.glsl", {}, tool)) {}

ScenePrograms::ScenePrograms(bool flatShading)
    : surface_(flatShading ? SurfaceShaders{"facet.vert.glsl", "facet.geom.glsl"} : SurfaceShaders{"sand.vert.glsl"}),
      wood_("solid.vert.glsl", "wood.frag.glsl"),
      tool_("solid.vert.glsl", "tool.frag.glsl") {
    (void)sand(true, SandLight::sunlit);
}

const SandPrograms& ScenePrograms::sand(bool ball, SandLight light) {
    std::optional<SandPrograms>& programs = sand_.at(static_cast<std::size_t>(light)).at(ball ? 0 : 1);
    if (!programs) {
        programs.emplace(surface_, light, ball ? "ball.glsl" : "stamp.glsl");
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
