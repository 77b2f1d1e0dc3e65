// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "render_node/gl/gl_program.hpp"

namespace render_node {

/// Shader files that place the surface's vertices, or that light whole triangles.
struct SurfaceShaders {
    std::string_view vertex;
    std::string_view geometry{};
};

/// Programs that draw the sand in one light.
struct SandPrograms {
    /// `light` and `tool` are names of files in shaders/.
    SandPrograms(const SurfaceShaders& surface, std::string_view light, std::string_view tool)
        : far({surface.vertex, "sand.frag.glsl", light, surface.geometry}),
          near({surface.vertex, "near.frag.glsl", light, surface.geometry, tool}),
          sides({"side.vert.glsl", "near.frag.glsl", light, {}, tool}) {}
    GlProgram far, near;  // the surface, outside and inside the tool's reach
    GlProgram sides;
};

/// All programs that draw a scene, without its marks and arrows.
///
/// Programs that most sessions never need are made when they are asked for. All functions throw std::runtime_error if a
/// shader does not compile. Used by one thread, with its context current.
class ScenePrograms {
public:
    explicit ScenePrograms(bool flatShading);

    /// Returns the programs for the sand. `ball` says that no tool takes light away, or one with the shape of a ball.
    [[nodiscard]] const SandPrograms& sand(bool ball, bool hillShade);
    /// Returns the program for the boards of the box.
    [[nodiscard]] const GlProgram& wood(bool ball);
    /// Returns the program for the tool.
    [[nodiscard]] const GlProgram& tool() const { return tool_; }
    /// Returns the program for the wires over the sand.
    [[nodiscard]] const GlProgram& wires();

private:
    SurfaceShaders surface_;
    SandPrograms sunlit_;
    std::optional<SandPrograms> hillShaded_;                     // made when the layer is first drawn
    std::optional<SandPrograms> stampSunlit_, stampHillShaded_;  // made for the first tool that is not a ball
    GlProgram wood_, tool_;
    std::optional<GlProgram> stampWood_, wires_;
};

}  // namespace render_node
