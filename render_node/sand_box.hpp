// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "render_node/gl/solid_mesh.hpp"
#include "render_node/surface/frustum.hpp"
#include "render_node/surface/sand_rim.hpp"
#include "scene/model/scene.hpp"

namespace render_node {

/// Box around the sand: its cut sides down to a floor and, with a closed rim, four wooden boards.
///
/// All lengths are in scene units. Used by one thread, with its context current.
class SandBox {
public:
    /// Makes a box around sand whose lowest place is at `lowest` [scene unit] and whose cells have the side `cellSize`
    /// [scene unit].
    SandBox(const SandRim& cut, float lowest, double cellSize, sand::Rim rim);

    /// Makes the sides again from `cut`, the current edge of the sand.
    void update(const SandRim& cut) { makeSides(cut); }
    /// Returns whether a box lies over the sand, at least two cells from all cuts. Returns false for any box if the
    /// field has holes.
    [[nodiscard]] bool insideRim(const Box& box) const;
    /// Returns `box`, extended by all places whose look depends on its contents. A side is lit at its upper and lower
    /// ends, so that it changes from top to bottom. The floor around a field without boards is visible.
    [[nodiscard]] Box withSides(const Box& box) const;
    /// Returns the lowest height at which a shadow beyond the rim can be seen.
    [[nodiscard]] double lowest() const { return bounds_.low.z; }
    /// Returns the largest height that the boards, or the sand at the rim, have ever had.
    [[nodiscard]] double highest() const { return bounds_.high.z; }

    /// Draws the sides that reach into the frustum, or all sides if `culling` is false. The program must be in use.
    void drawSides(const glm::dmat4& sceneToClip, bool culling) const;
    void drawBoards() const { boards_.draw(); }

private:
    void makeSides(const SandRim& cut);
    void makeBoards(const SandRim& cut, sand::Rim rim);

    /// Part of a side that is drawn with one call.
    struct Run {
        GLint firstVertex;
        GLsizei vertices;
        Box box;
    };
    Box bounds_;                                   // of the whole box, and of all sand that has ever been at the rim
    double cellSize_ = 0, width_ = 0, depth_ = 0;  // of the field [scene unit]
    bool hasHoles_ = false;
    float floor_ = 0;  // [scene unit]
    float top_ = 0;    // upper edge of the boards [scene unit]
    SolidMesh sides_, boards_;
    std::vector<Run> runs_;
};

}  // namespace render_node
