// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render_node/sand_surface.hpp"
#include "render_node/solid_mesh.hpp"
#include "sand/scene.hpp"

namespace render_node {

/// What the sand lies in: its cut sides down to a floor, and, where the rim is closed, four wooden boards.
///
/// All in scene units. One thread, its context current.
class SandBox {
public:
    SandBox(const SandSurface& surface, sand::Rim rim);

    /// These cells have changed: the sides follow when they touch the rim.
    void update(const SandSurface& surface, const sand::Rect& cells);
    /// Counts the changes of the sides.
    [[nodiscard]] std::uint64_t revision() const { return revision_; }

    void drawSides() const { sides_.draw(); }
    void drawBoards() const { boards_.draw(); }

private:
    void makeSides(const SandSurface& surface);
    void makeBoards(const SandSurface& surface, sand::Rim rim);

    std::uint64_t revision_ = 0;
    float floor_ = 0;  // [scene unit]
    float top_ = 0;    // of the boards [scene unit]
    SolidMesh sides_, boards_;
};

}  // namespace render_node
