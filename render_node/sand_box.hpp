// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "render_node/gl/solid_mesh.hpp"
#include "render_node/surface/frustum.hpp"
#include "render_node/surface/sand_rim.hpp"
#include "scene/scene.hpp"

namespace render_node {

/// What the sand lies in: its cut sides down to a floor, and, where the rim is closed, four wooden boards.
///
/// All in scene units. One thread, its context current.
class SandBox {
public:
    /// Around sand whose lowest place is at `lowest`, of cells of that size [scene unit].
    SandBox(const SandRim& cut, float lowest, double cellSize, sand::Rim rim);

    /// The sides follow.
    void update(const SandRim& cut) { makeSides(cut); }
    /// Whether a box lies over the sand, nowhere near the rim.
    [[nodiscard]] bool insideRim(const Box& box) const;
    /// A box in the scene, grown by all whose look depends on what is in it: a side is lit at its upper and lower ends,
    /// so that it changes from top to bottom, and the floor lies open around a field without boards.
    [[nodiscard]] Box withSides(const Box& box) const;
    /// How deep a shadow that ends beyond the rim may be seen.
    [[nodiscard]] double lowest() const { return bounds_.low.z; }
    /// The highest that boards or the sand beside them have been.
    [[nodiscard]] double highest() const { return bounds_.high.z; }

    /// Draws the sides that reach into the frustum; all of them when `culling` is off. The program must be in use.
    void drawSides(const glm::dmat4& sceneToClip, bool culling) const;
    void drawBoards() const { boards_.draw(); }

private:
    void makeSides(const SandRim& cut);
    void makeBoards(const SandRim& cut, sand::Rim rim);

    /// A piece of a side.
    struct Run {
        GLint firstVertex;
        GLsizei vertices;
        Box box;
    };
    Box bounds_;                                   // of everything, sand at the rim included, ever
    double cellSize_ = 0, width_ = 0, depth_ = 0;  // of the field [scene unit]
    float floor_ = 0;                              // [scene unit]
    float top_ = 0;                                // of the boards [scene unit]
    SolidMesh sides_, boards_;
    std::vector<Run> runs_;
};

}  // namespace render_node
