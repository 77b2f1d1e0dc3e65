// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render_node/solid_mesh.hpp"

namespace render_node {

/// Triangles of a sphere of radius 1 around the origin: an icosahedron, each face split into four, `splits` times.
[[nodiscard]] std::vector<SolidVertex> makeSphere(int splits);

/// The tool of radius 1: the shader moves and scales it.
class ToolMesh {
public:
    ToolMesh() { mesh_.set(makeSphere(3)); }
    void draw() const { mesh_.draw(); }

private:
    SolidMesh mesh_;
};

}  // namespace render_node
