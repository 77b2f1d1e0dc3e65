// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "lockstep/overlays.hpp"
#include "render_node/gl/pixel_rect.hpp"
#include "render_node/surface/drawn_surface.hpp"
#include "render_node/tool/force_arrow.hpp"
#include "shapes/sand_box.hpp"
#include "shapes/tool/drawn_tool.hpp"

namespace render_node {

/// Camera of one eye of one tile.
struct Camera {
    glm::dmat4 roomToClip{1};  // matrix from metres in the room to OpenGL clip coordinates
    glm::dvec3 eye{0};         // [m], room
    friend bool operator==(const Camera&, const Camera&) = default;
};

/// What a picture shows besides the sand.
struct ShownScene {
    glm::dmat4 sceneToRoom{1};
    float toolRadius = 0;                   // [scene unit], of the tool, whether or not it has a place
    std::optional<shapes::DrawnTool> tool;  // nullopt before the tool has a place
    std::optional<ForceArrow> force;
    lockstep::Overlays layers;  // only the layers that change every pixel of the sand
    double humidity = 0;        // of the sand, 0 to 1
    bool sharp = false;         // whether moving sand is drawn as finely as sand at rest
};

/// Record of the picture that one view has last drawn into one target. The caller keeps one for each eye.
struct EyeMemory {
    bool drawn = false;  // false: the next drawing draws the whole picture
    Camera camera;
    ShownScene scene;
    std::uint64_t sand = 0;  // revision
    DrawnLevels levels;
    PixelRect covered{};  // pixels that something else was drawn over, and that must be drawn again
};

/// Finds the pixels of a picture that must be drawn again. Used by one thread.
class Redraw {
public:
    /// All must outlive this object. `sun` points towards the sun and has length 1.
    Redraw(DrawnSurface& surface, const shapes::SandBox& box, const glm::vec3& sun)
        : surface_(surface), box_(box), sun_(sun) {}

    /// Returns a few rectangles that contain all pixels that may differ between the picture which `memory` describes
    /// and the next one. `size` is that of both pictures, and `rule` chooses the level of detail. Updates
    /// memory.levels to those of the next picture.
    [[nodiscard]] std::vector<PixelRect> pixels(const Camera& camera, const ShownScene& scene,
                                                glm::ivec2 size /* [pixel] */, const LevelRule& rule,
                                                EyeMemory& memory);

private:
    [[nodiscard]] std::vector<std::vector<glm::dvec3>> hullsOf(const shapes::DrawnTool& tool) const;

    DrawnSurface& surface_;
    const shapes::SandBox& box_;
    glm::dvec3 sun_;
};

}  // namespace render_node
