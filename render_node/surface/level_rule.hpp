// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>

#include "shapes/model/box.hpp"
#include "shapes/model/levels.hpp"

namespace render_node {

/// Largest error of each level over all vertices of a chunk.
struct LevelErrors {
    std::array<float, shapes::kLevels> height{};  // [scene unit], along the vertical
    std::array<float, shapes::kLevels> light{};   // share of the sun's full light, mottling included
};

/// Rule for the level at which a chunk is drawn.
///
/// The rule depends only on the scene, the eye, and the plane and density of the pixels, so that the tiles of one plane
/// agree. It chooses the coarsest level that satisfies two limits. It shifts no point of the picture by more than
/// `bound`. It changes the sun's light on no point by more than `bound` × kLightPerPixel. Cells may be much smaller
/// than a pixel. Then the finest level that a picture can show takes the place of every cell.
class LevelRule {
public:
    static constexpr double kLightPerPixel = 0.08;  // [1/pixel], share of the sun's full light: about 8 levels of 255
    static constexpr double kPixelsPerQuad = 4;     // of moving sand

    /// With `bound` 0 the rule chooses level 0 everywhere. With `pixelsPerQuad` 0, moving sand gets the level of sand
    /// at rest.
    LevelRule(const glm::dmat4& sceneToClip, glm::ivec2 size /* [pixel] */, double bound /* [pixel] */,
              double pixelsPerQuad = kPixelsPerQuad);
    /// Equal rules choose equal levels for equal sand.
    bool operator==(const LevelRule&) const = default;
    /// Returns whether moving sand has a level of its own.
    [[nodiscard]] bool coarsensMovement() const { return pixelsPerQuad_ > 0 && !needsEveryCell(); }
    /// Returns whether the rule chooses level 0 whatever the errors are.
    [[nodiscard]] bool needsEveryCell() const { return bound_ <= 0; }
    /// Returns whether a box may reach into the picture.
    [[nodiscard]] bool sees(const shapes::Box& box) const { return shapes::inFrustum(box, sceneToClip_); }
    /// Returns the finest level that the picture can show of the sand within `box`, at most `coarsest`. It is the
    /// coarsest level at which each point is at most `bound` from a vertex, along both axes of the field. Finer levels
    /// would show other samples of the same sand, and take longer. `cell` is the side of a cell [scene unit]. Returns 0
    /// if a part of the box is behind the eye.
    [[nodiscard]] int finest(const shapes::Box& box, double cell, int coarsest) const;
    /// Returns the level for the sand within `box`, at most `coarsest` and at least `finest`.
    [[nodiscard]] int level(const shapes::Box& box, const LevelErrors& errors, int finest, int coarsest) const;
    /// Returns the level for moving sand within `box`, at most `coarsest`. It is the finest level at which a level quad
    /// covers at least `pixelsPerQuad`. The errors of the sand do not matter. `cell` is the side of a cell [scene
    /// unit]. Returns nullopt if a part of the box is behind the eye. The rule of resting sand must then choose.
    [[nodiscard]] std::optional<int> levelWhileMoving(const shapes::Box& box, double cell, int coarsest) const;

private:
    [[nodiscard]] double pixelsPerUnit(const shapes::Box& box, int axis) const;

    glm::dmat4 sceneToClip_;
    glm::dvec2 half_;  // [pixel], half of the picture's size
    double bound_;     // [pixel]
    double pixelsPerQuad_;
};

}  // namespace render_node
