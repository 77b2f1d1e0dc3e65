// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "lockstep/overlays.hpp"
#include "render_node/gl/eye_target.hpp"
#include "render_node/gl/gl_program.hpp"
#include "render_node/gl/grain_texture.hpp"
#include "render_node/gl/pixel_rect.hpp"
#include "render_node/sand_box.hpp"
#include "render_node/surface/drawn_surface.hpp"
#include "render_node/tool/drawn_tool.hpp"
#include "render_node/tool/force_arrow.hpp"
#include "render_node/tool/light.hpp"
#include "render_node/tool/mesh.hpp"
#include "render_node/tool/reach.hpp"
#include "sand/model/step.hpp"
#include "sand/model/surface_data.hpp"
#include "scene/scene.hpp"

namespace render_node {

/// Camera of one eye of one tile.
struct Camera {
    glm::dmat4 roomToClip;  // matrix from metres in the room to OpenGL clip coordinates
    glm::dvec3 eye;         // [m], room
};

/// Counts of the last draw() or drawIfChanged(). A chunk in two rectangles counts twice.
struct DrawCounts {
    int chunks = 0;           // drawn chunks of sand
    int coarseChunks = 0;     // drawn chunks above level 0
    int chunksOfField = 0;    // all chunks of the field
    int triangles = 0;        // drawn triangles of sand
    std::int64_t pixels = 0;  // in the drawn rectangles
};

/// Record of the picture that one view has last drawn into one target. The caller keeps one for each eye.
struct EyeMemory {
    bool drawn = false;  // false: the next drawIfChanged() draws the whole picture
    glm::dmat4 roomToClip{1}, sceneToRoom{1};
    glm::dvec3 eye{0};
    std::uint64_t sand = 0;  // revision
    DrawnLevels levels;
    std::optional<DrawnTool> tool;
    std::optional<ForceArrow> force;
    lockstep::Overlays layers;  // only the layers that change every pixel of the sand
    PixelRect covered{};        // pixels that something else was drawn over, and that must be drawn again
};

/// Shader files that place the surface's vertices, or that light whole triangles.
struct SurfaceShaders {
    std::string_view vertex;
    std::string_view geometry{};
};

/// Programs that draw the sand in one light.
struct SandPrograms {
    /// `light` and `tool` are names of files in shaders/.
    SandPrograms(const SurfaceShaders& surface, std::string_view light, std::string_view tool)
        : far({surface.vertex, "sand.frag.glsl", light, surface.geometry}),
          near({surface.vertex, "near.frag.glsl", light, surface.geometry, tool}),
          sides({"side.vert.glsl", "near.frag.glsl", light, {}, tool}) {}
    GlProgram far, near;  // the surface, outside and inside the tool's reach
    GlProgram sides;
};

/// Painter of a scene: sand, the box around it, and the tool.
///
/// Scene axes are x east, y north, z up, in scene units. The origin is at the south-west corner of the field, at height
/// 0. `sceneToRoom` transforms scene coordinates to metres in the room. It turns and moves the scene, and scales all
/// axes alike. Every position and colour depends only on the scene, so that the tiles of a wall join. Only chunks that
/// a camera sees are built, sent to GL and drawn. The GL context must be current. Used by one thread.
class ScenePainter {
public:
    /// Takes the tool and the look from `scene`. `start` is the sand of a replica before its first step.
    /// Throws std::runtime_error if a shader does not compile.
    ScenePainter(const scene::Scene& scene, const sand::SurfaceData& start, const glm::dmat4& sceneToRoom);
    /// Takes the sand from `scene`, which must have a height field.
    ScenePainter(const scene::Scene& scene, const glm::dmat4& sceneToRoom);

    /// Sets the transformation from the scene to the room for all further drawing.
    void setSceneToRoom(const glm::dmat4& sceneToRoom) { sceneToRoom_ = sceneToRoom; }
    /// Copies the changes of the sand. The sand must have the kind and size of `start`.
    ///
    /// @param cameras  The only cameras that draw before the next update. Changes that no camera sees may be postponed
    ///          until one does. An empty list means that all changes are seen.
    void update(const sand::SurfaceData& data, const sand::SurfaceChange& change, std::span<const Camera> cameras = {});
    /// Returns the lowest and the highest height that any sand has ever had.
    [[nodiscard]] HeightRange heightsEver() const { return surface_->heightsEver(); }
    /// Sets the tool's centre. No tool is drawn before the first call.
    void setTool(sand::ProbePoint centre, bool engaged);
    /// Sets the tool and its centre. Use it if the tool differs from the last one or was turned.
    void setTool(sand::ProbePoint centre, bool engaged, const sand::Tool& tool);

    /// Shows or hides hill-shade and wireframe; ignores all other layers. The next draw() makes the programs of a layer
    /// that is shown for the first time. It then throws std::runtime_error if a shader does not compile.
    void setLayers(lockstep::Overlays layers);
    /// Shows this arrow from now on, or no arrow, as at first. The first draw() with an arrow throws std::runtime_error
    /// if a shader does not compile.
    void setForce(const std::optional<ForceArrow>& force) { force_ = force; }

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

private:
    [[nodiscard]] SurfaceShaders shaders() const;
    void prepare(const GlProgram& program, const Camera& camera) const;
    void prepareTool(const GlProgram& program) const;
    void prepareSurface(const GlProgram& program, const Camera& camera) const;
    void drawTool(const Camera& camera, const glm::dmat4& sceneToPart);
    void drawForce(const Camera& camera);
    void drawSand(const Camera& camera, const glm::dmat4& sceneToPart, const LevelRule& rule);
    void drawWires(const Camera& camera, const glm::dmat4& sceneToPart, const LevelRule& rule);
    void startCounting();
    void drawWithin(const PixelRect& pixels, const Camera& camera, const EyeTarget& target);
    [[nodiscard]] LevelRule ruleFor(const Camera& camera, glm::ivec2 size) const;
    [[nodiscard]] std::vector<PixelRect> changedPixels(const Camera& camera, glm::ivec2 size, EyeMemory& memory);
    [[nodiscard]] const SandPrograms& sandPrograms();
    [[nodiscard]] const GlProgram& woodProgram();
    [[nodiscard]] static Box bodyOf(const DrawnTool& tool);
    [[nodiscard]] ToolReach reachOf(const DrawnTool& tool) const;
    [[nodiscard]] std::vector<std::vector<glm::dvec3>> hullsOf(const DrawnTool& tool) const;
    [[nodiscard]] float toolRadius() const;  // [scene unit], of the current tool

    glm::dmat4 sceneToRoom_;
    scene::Look look_;
    glm::vec2 halfPicture_{};  // [pixel], half of the size of the current picture
    glm::vec3 sun_;            // towards the sun, of length 1
    double cellSize_;          // [scene unit]; places are computed from its float, as in the shaders
    sand::Tool tool_;
    std::optional<DrawnTool> drawnTool_;  // nullopt before the first setTool()
    std::optional<ForceArrow> force_;
    lockstep::Overlays overlays_;
    bool culling_ = true;
    DrawCounts counts_;

    std::unique_ptr<DrawnSurface> surface_;
    SandPrograms sunlit_;
    std::optional<SandPrograms> hillShaded_;  // made when the layer is first drawn, like the members below
    std::optional<SandPrograms> stampSunlit_, stampHillShaded_;  // made for the first tool that is not a ball
    std::optional<GlProgram> stampWood_;
    std::optional<GlProgram> wireProgram_;
    std::optional<ForceArrowView> forceView_;
    GlProgram woodProgram_, toolProgram_;
    GrainTexture grain_;
    SandBox box_;
    ToolMesh toolMesh_;
};

}  // namespace render_node
