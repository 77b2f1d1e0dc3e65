// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "render_node/gl/gl_program.hpp"
#include "render_node/gl/solid_mesh.hpp"
#include "shapes/model/box.hpp"

namespace render_node {

/// Arrow of the tool's force: it begins on the tool's surface and points along the force.
struct ForceArrow {
    glm::vec3 from, to;  // [scene unit], two different points
    bool longest;        // the force is at least kMostNewtons
    friend bool operator==(const ForceArrow&, const ForceArrow&) = default;
};

/// Returns the triangles of an arrow: a shaft and a head, with a thickness for a tool of radius `toolRadius` [scene
/// unit].
[[nodiscard]] std::vector<shapes::SolidVertex> makeArrow(const ForceArrow& arrow, float toolRadius);
/// Returns a box around the triangles of makeArrow().
[[nodiscard]] shapes::Box boxOf(const ForceArrow& arrow, float toolRadius);

/// Arrow in GL. Used by one thread, with its context current.
class ForceArrowView {
public:
    /// Throws std::runtime_error if a shader does not compile.
    ForceArrowView() : program_("solid.vert.glsl", "arrow.frag.glsl") {}
    [[nodiscard]] const GlProgram& program() const { return program_; }
    /// Draws the arrow. The program must be in use, with its camera set.
    void draw(const ForceArrow& arrow, float toolRadius);

private:
    GlProgram program_;
    SolidMesh mesh_;
};

}  // namespace render_node
