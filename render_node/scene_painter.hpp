// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render_node/box_mesh.hpp"
#include "render_node/gl/eye_target.hpp"
#include "render_node/gl/grain_texture.hpp"
#include "render_node/redraw.hpp"
#include "render_node/scene_programs.hpp"
#include "render_node/surface/drawn_surface.hpp"
#include "render_node/tool/force_arrow.hpp"
#include "render_node/tool/mesh.hpp"
#include "sand/model/step.hpp"
#include "sand/model/surface_data.hpp"
#include "scene/model/scene.hpp"

namespace render_node {

/// Counts of the last draw() or drawIfChanged(). A chunk in two rectangles counts twice.
struct DrawCounts {
    int chunks = 0;           // drawn chunks of sand
    int coarseChunks = 0;     // drawn chunks above level 0
    int chunksOfField = 0;    // all chunks of the field
    int triangles = 0;        // drawn triangles of sand
    std::int64_t pixels = 0;  // in the drawn rectangles
};

/// Painter of a scene: sand, the box around it, and the tool.
///
/// Scene axes are x east, y north, z up, in scene units. The origin is at the south-west corner of the field, at height
/// 0. `sceneToRoom` transforms scene coordinates to metres in the room. It turns and moves the scene, and scales all
/// axes alike. Every position and colour depends only on the scene, so that the tiles of a wall join. Only chunks that
/// a camera sees are built, sent to GL and drawn. The GL context must be current. Used by one thread.
class ScenePainter {
public:
    /// Takes the tool and the look from `scene`. `start` is the sand of a replica before its first step. `sceneToRoom`
    /// is the usual view, in which the grain has its size (kGrainTexel). Throws std::runtime_error if a shader does not
    /// compile.
    ScenePainter(const scene::Scene& scene, const sand::SurfaceData& start, const glm::dmat4& sceneToRoom);
    /// Takes the sand from `scene`, which must have a height field.
    ScenePainter(const scene::Scene& scene, const glm::dmat4& sceneToRoom);

    /// Sets the transformation from the scene to the room for all further drawing.
    void setSceneToRoom(const glm::dmat4& sceneToRoom) { shown_.sceneToRoom = sceneToRoom; }
    /// Copies the changes of the sand. The sand must have the kind and size of `start`.
    ///
    /// @param cameras  The only cameras that draw before the next update. Changes that no camera sees may be postponed
    ///          until one does. An empty list means that all changes are seen.
    void update(const sand::SurfaceData& data, const sand::SurfaceChange& change, std::span<const Camera> cameras = {});
    /// Returns the lowest and the highest height that any sand has ever had.
    [[nodiscard]] shapes::HeightRange heightsEver() const { return surface_->heightsEver(); }
    /// Moves the tool's centre to `probe`. No tool is drawn before the first call.
    void setTool(sand::ProbePoint probe, bool engaged);
    /// Moves the tool and sets it. Use it if the tool differs from the last one or was turned.
    void setTool(sand::ProbePoint probe, bool engaged, const sand::Tool& tool);

    /// Shows or hides hill-shade and wireframe; ignores all other layers. The next draw() makes the programs of a layer
    /// that is shown for the first time. It then throws std::runtime_error if a shader does not compile.
    void setLayers(lockstep::Overlays layers);
    /// Draws wet sand from now on: darker and with a sheen, by its humidity from 0 (dry) to 1. At first the humidity is
    /// that of the scene's material. The first drawing of wet sand makes its programs, as setLayers() says.
    void setHumidity(double humidity) { shown_.humidity = humidity; }
    /// Draws moving sand from now on as finely as sand at rest, or, as at first, more coarsely.
    void setSharp(bool sharp) { shown_.sharp = sharp; }
    /// Shows this arrow from now on, or no arrow, as at first. The first draw() with an arrow throws std::runtime_error
    /// if a shader does not compile.
    void setForce(const std::optional<ForceArrow>& force) { shown_.force = force; }

    /// Clears the target and draws everything into it. Does not wait for GL; EyeTarget::finish() waits.
    void draw(const Camera& camera, const EyeTarget& target);
    /// Draws a few rectangles that contain all pixels that may differ from the picture in the target, which `memory`
    /// describes. The target then equals the result of draw() bit for bit.
    ///
    /// Returns the rectangle around the drawn ones. It is empty if nothing was drawn, as on most tiles, which are far
    /// from the hand. It is the whole picture if the view changed or if most of the picture changed.
    PixelRect drawIfChanged(const Camera& camera, const EyeTarget& target, EyeMemory& memory);

    /// Returns the counts of the last drawing.
    [[nodiscard]] const DrawCounts& counts() const { return counts_; }
    /// Returns the memory for geometry that this object uses in GL [byte].
    [[nodiscard]] std::size_t geometryBytes() const { return surface_->bytes(); }
    /// Returns the number of heights that updates have read, or of vertices and triangles of a TIN. For measurements.
    [[nodiscard]] std::int64_t placesRead() const { return surface_->placesRead(); }
    /// Turns culling on or off. Without culling every chunk is drawn. For measurements of the gain from culling.
    void setCulling(bool culling) { culling_ = culling; }
    /// Sets the largest distance by which the level of detail may shift the picture of any sand [pixel]. It replaces
    /// the scene's look.detail. The caller must reset EyeMemory::drawn of its memories.
    void setDetail(double bound) { look_.detail = bound; }
    /// Sets the least area of the quads of moving sand [pixel], for measurements. It replaces
    /// LevelRule::kPixelsPerQuad. The caller must reset EyeMemory::drawn of its memories.
    void setPixelsPerQuad(double pixels) { pixelsPerQuad_ = pixels; }
    /// Returns the work of all drawing so far. For measurements.
    [[nodiscard]] DrawnSurface::Work work() const { return surface_->work(); }

private:
    /// Drawing of one rectangle of a picture.
    struct Pass {
        const Camera& camera;
        glm::ivec2 size;         // [pixel], of the whole picture
        glm::dmat4 sceneToPart;  // matrix from the scene to clip coordinates of the rectangle
        LevelRule rule;
    };
    void drawWithin(const PixelRect& pixels, const Camera& camera, const EyeTarget& target);
    void prepare(const GlProgram& program, const Pass& pass) const;
    void prepareTool(const GlProgram& program) const;
    void prepareSurface(const GlProgram& program, const Pass& pass) const;
    void drawTool(const Pass& pass);
    void drawForce(const Pass& pass);
    void drawSand(const Pass& pass);
    void drawWires(const Pass& pass);
    void startCounting();
    /// Returns the periods of the grain per scene unit in the current view.
    [[nodiscard]] float grainScale() const;
    /// Returns whether no tool takes light away, or one with the shape of a ball.
    [[nodiscard]] bool hasBall() const { return !shown_.tool || shown_.tool->isBall(); }
    /// Returns whether the tool is drawn.
    [[nodiscard]] bool showsTool() const { return shown_.tool && shown_.tool->radius > 0; }
    /// Returns the light in which the sand is drawn.
    [[nodiscard]] SandLight sandLight() const;
    [[nodiscard]] LevelRule ruleFor(const Camera& camera, glm::ivec2 size) const;
    [[nodiscard]] float toolRadius() const;  // [scene unit], of the current tool

    scene::Look look_;
    glm::vec3 sun_;      // towards the sun, of length 1
    double cellSize_;    // [scene unit]; places are computed from its float, as in the shaders
    double usualScale_;  // [m per scene unit], of the usual view
    sand::Tool tool_;
    ShownScene shown_;
    double pixelsPerQuad_ = LevelRule::kPixelsPerQuad;
    bool culling_ = true;
    DrawCounts counts_;
    std::unique_ptr<DrawnSurface> surface_;
    ScenePrograms programs_;
    std::optional<ForceArrowView> forceView_;  // made for the first arrow
    GrainTexture grain_;
    std::unique_ptr<shapes::SandBox> box_;  // stays where it is for boxMesh_ when this object moves
    BoxMesh boxMesh_;
    ToolMesh toolMesh_;
};

}  // namespace render_node
