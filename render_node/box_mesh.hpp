// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render_node/gl/solid_mesh.hpp"
#include "shapes/sand_box.hpp"

namespace render_node {

/// The box around the sand in GL. Used by one thread, with its context current.
class BoxMesh {
public:
    /// `box` must outlive this object.
    explicit BoxMesh(const shapes::SandBox& box) : box_(box) {
        sides_.set(box.sides());
        boards_.set(box.boards());
    }

    /// Takes the sides of the box again.
    void update() { sides_.set(box_.sides()); }
    /// Draws the sides that reach into the frustum, or all sides if `culling` is false. The program must be in use.
    void drawSides(const glm::dmat4& sceneToClip, bool culling) const {
        for (const shapes::SandBox::Run& run : box_.runs()) {
            if (!culling || inFrustum(run.box, sceneToClip)) {
                sides_.draw(run.firstVertex, run.vertices);
            }
        }
    }
    void drawBoards() const { boards_.draw(); }

private:
    const shapes::SandBox& box_;
    SolidMesh sides_, boards_;
};

}  // namespace render_node
