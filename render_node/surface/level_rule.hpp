// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "render_node/surface/frustum.hpp"

namespace render_node {

/// Level l of a chunk stands on every 2^l-th vertex of the sand, and these are the same vertices in every level: only
/// what lies between them is smoothed over.
inline constexpr int kLevels = 5;

/// How far each level of a chunk is from all of its vertices, at its worst place.
struct LevelErrors {
    std::array<float, kLevels> height{};  // [scene unit], along the vertical
    std::array<float, kLevels> light{};   // of the sun's full light, mottling in it
};

/// Which level a camera asks for: a function of the scene, the eye, and the plane and density of the pixels, so that
/// the tiles of one plane agree.
///
/// The coarsest level that shifts no point of the picture by more than the bound, and changes the sun's light on none
/// by more than that allows.
class LevelRule {
public:
    static constexpr double kLightPerPixel = 0.08;  // [1/pixel], of the sun's full light: about 8 levels of 255

    /// `bound` 0 asks for level 0 everywhere.
    LevelRule(const glm::dmat4& sceneToClip, glm::ivec2 size /* [pixel] */, double bound /* [pixel] */);
    /// Whether it asks for level 0, whatever the errors.
    [[nodiscard]] bool wantsEveryCell() const { return bound_ <= 0; }
    /// Whether a box may reach into its picture.
    [[nodiscard]] bool sees(const Box& box) const { return inFrustum(box, sceneToClip_); }
    /// For the sand within a box.
    [[nodiscard]] int level(const Box& box, const LevelErrors& errors, int coarsest) const;

private:
    [[nodiscard]] double pixelsPerUnit(const Box& box) const;

    glm::dmat4 sceneToClip_;
    glm::dvec2 half_;  // [pixel], the picture
    double bound_;     // [pixel]
};

}  // namespace render_node
