// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "render_node/gl/gl_program.hpp"
#include "render_node/gl/solid_mesh.hpp"
#include "render_node/surface/frustum.hpp"

namespace render_node {

/// The tool's force as it is shown: from the tool's surface, along the force.
struct ForceArrow {
    glm::vec3 from, to;  // [scene unit], apart
    bool longest;        // the force is the greatest that there is an arrow for
    friend bool operator==(const ForceArrow&, const ForceArrow&) = default;
};

/// Its triangles, a shaft and a head, as thick as suits a tool of this radius [scene unit].
[[nodiscard]] std::vector<SolidVertex> makeArrow(const ForceArrow& arrow, float toolRadius);
/// A box around these triangles.
[[nodiscard]] Box boxOf(const ForceArrow& arrow, float toolRadius);

/// An arrow in GL. One thread, its context current.
class ForceArrowView {
public:
    /// Throws std::runtime_error when a shader does not compile.
    ForceArrowView() : program_("solid.vert.glsl", "arrow.frag.glsl") {}
    [[nodiscard]] const GlProgram& program() const { return program_; }
    /// The program must be in use and have its view.
    void draw(const ForceArrow& arrow, float toolRadius);

private:
    GlProgram program_;
    SolidMesh mesh_;
};

}  // namespace render_node
