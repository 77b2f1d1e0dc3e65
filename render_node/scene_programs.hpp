// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "render_node/gl/gl_program.hpp"

namespace render_node {

/// Shader files that place the surface's vertices, or that light whole triangles.
struct SurfaceShaders {
    std::string_view vertex;
    std::string_view geometry{};
};

/// Light in which the sand is drawn.
enum class SandLight : std::uint8_t { sunlit, wet, hillShade };

/// Programs that draw the sand in one light.
struct SandPrograms {
    /// `tool` is the name of a file in shaders/.
    SandPrograms(const SurfaceShaders& surface, SandLight light, std::string_view tool);
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
    [[nodiscard]] const SandPrograms& sand(bool ball, SandLight light);
    /// Returns the program for the boards of the box.
    [[nodiscard]] const GlProgram& wood(bool ball);
    /// Returns the program for the tool.
    [[nodiscard]] const GlProgram& tool() const { return tool_; }
    /// Returns the program for the wires over the sand.
    [[nodiscard]] const GlProgram& wires();

private:
    SurfaceShaders surface_;
    // For each light, with a ball and with another tool. Made when they are first drawn, except those of most sessions.
    std::array<std::array<std::optional<SandPrograms>, 2>, 3> sand_;
    GlProgram wood_, tool_;
    std::optional<GlProgram> stampWood_, wires_;
};

}  // namespace render_node
