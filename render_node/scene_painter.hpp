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
#include "render_node/sand_box.hpp"
#include "render_node/surface/drawn_surface.hpp"
#include "render_node/surface/pixel_rect.hpp"
#include "render_node/tool/force_arrow.hpp"
#include "render_node/tool/light.hpp"
#include "render_node/tool/mesh.hpp"
#include "render_node/tool/reach.hpp"
#include "sand/model/step.hpp"
#include "sand/model/surface_data.hpp"
#include "scene/scene.hpp"

namespace render_node {

/// One eye of one tile.
struct Camera {
    glm::dmat4 roomToClip;  // OpenGL clip coordinates from metres in the room
    glm::dvec3 eye;         // [m], room
};

/// What the last draw() or drawIfChanged() did; a chunk in two rectangles counts twice.
struct DrawCounts {
    int chunks = 0;           // of sand, drawn
    int coarseChunks = 0;     // of these, above level 0
    int chunksOfField = 0;    // that the field has
    int triangles = 0;        // of sand, drawn
    std::int64_t pixels = 0;  // in the rectangles that were drawn
};

/// What was drawn last into one target by one view: the caller keeps one per eye.
struct EyeMemory {
    struct Tool {
        glm::vec3 centre;  // [scene unit]
        bool engaged;
        float radius;  // [scene unit]
        sand::ToolShape shape;
        sand::Heading heading;
        friend bool operator==(const Tool&, const Tool&) = default;
    };
    bool drawn = false;  // reset to draw anew whatever has changed
    glm::dmat4 roomToClip{1}, sceneToRoom{1};
    glm::dvec3 eye{0};
    std::uint64_t sand = 0;  // revision
    DrawnLevels levels;
    std::optional<Tool> tool;
    std::optional<ForceArrow> force;
    lockstep::Overlays layers;  // of those that change every pixel of sand
    PixelRect covered{};        // that something else was drawn over since, and is to go
};

/// The files that place the surface's vertices, and light them or whole triangles.
struct SurfaceShaders {
    std::string_view vertex;
    std::string_view geometry{};
};

/// What draws the sand in one light.
struct SandPrograms {
    /// `light` and `tool` are files of shaders/.
    SandPrograms(const SurfaceShaders& surface, std::string_view light, std::string_view tool)
        : far({surface.vertex, "sand.frag.glsl", light, surface.geometry}),
          near({surface.vertex, "near.frag.glsl", light, surface.geometry, tool}),
          sides({"side.vert.glsl", "near.frag.glsl", light, {}, tool}) {}
    GlProgram far, near;  // the surface, beyond the tool's reach and within
    GlProgram sides;
};

/// The scene as a person sees it: sand, the box it lies in, and the tool.
///
/// Scene axes are x east, y north, z up, with the origin at the south-west corner of the field and height 0, in scene
/// units; `sceneToRoom` (a similarity: turned, moved and scaled alike in all axes) takes them to metres in the room.
/// Every position and colour is a function of the scene alone, so that the tiles of a wall join. Only the chunks a
/// camera sees are ever built, sent to GL and drawn. Needs its context current; one thread.
class ScenePainter {
public:
    /// Takes tool radius and look from the scene, and the sand from `start`: that of a replica that has made no step.
    /// Throws std::runtime_error when a shader does not compile.
    ScenePainter(const scene::Scene& scene, const sand::SurfaceData& start, const glm::dmat4& sceneToRoom);
    /// Takes the sand from the scene, which must be a height field.
    ScenePainter(const scene::Scene& scene, const glm::dmat4& sceneToRoom);

    /// Where the scene stands from now on.
    void setSceneToRoom(const glm::dmat4& sceneToRoom) { sceneToRoom_ = sceneToRoom; }
    /// Takes over what changed of the sand, which is copied. It must be of the kind and size of that at the start. With
    /// cameras, the only ones that will draw before the next update: what none of them can see may be put off until
    /// one can.
    void update(const sand::SurfaceData& data, const sand::SurfaceChange& change, std::span<const Camera> cameras = {});
    /// Where the tool's centre is. No tool is drawn before the first call.
    void setTool(sand::ProbePoint centre, bool engaged);
    /// The same for another tool than the scene's or that of before, or one that was turned.
    void setTool(sand::ProbePoint centre, bool engaged, const sand::ToolShape& shape, const sand::Heading& heading);

    /// Hill-shade and wireframe; other layers are not drawn here. What a layer needs of GL is made when it is first
    /// drawn, which throws std::runtime_error when a shader does not compile.
    void setLayers(lockstep::Overlays layers);
    /// Draws this arrow from now on, or none, as at first. Likewise.
    void setForce(const std::optional<ForceArrow>& force) { force_ = force; }

    /// Clears the target and draws everything into it. Does not wait: EyeTarget::finish() does.
    void draw(const Camera& camera, const EyeTarget& target);
    /// Draws few rectangles outside of which no pixel can differ from what `memory` says is in the target, and returns
    /// the one around them: empty where nothing was drawn (most tiles are far from the hand), the whole picture where
    /// the view is another one or most of it changed. The target then holds what draw() would have left there, bit for
    /// bit.
    PixelRect drawIfChanged(const Camera& camera, const EyeTarget& target, EyeMemory& memory);

    /// Of what was drawn last.
    [[nodiscard]] const DrawCounts& counts() const { return counts_; }
    /// Bytes this view has asked of GL for geometry so far.
    [[nodiscard]] std::size_t geometryBytes() const { return surface_->bytes(); }
    /// Heights that updates have read so far, or vertices and triangles of a TIN: for measurements.
    [[nodiscard]] std::int64_t placesRead() const { return surface_->placesRead(); }
    /// Draws every chunk, seen or not: for measurements of what culling gains.
    void setCulling(bool culling) { culling_ = culling; }
    /// How far the level of detail may shift the picture of any sand, in place of the scene's look.detail [pixel]. Who
    /// keeps an EyeMemory must have it drawn anew.
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
    [[nodiscard]] static ToolLight lightOf(const EyeMemory::Tool& tool);
    [[nodiscard]] static Box bodyOf(const EyeMemory::Tool& tool);
    [[nodiscard]] static bool isBall(const EyeMemory::Tool& tool) { return tool.shape.kind == sand::ToolKind::sphere; }
    [[nodiscard]] ToolReach reachOf(const EyeMemory::Tool& tool) const;
    [[nodiscard]] std::vector<std::vector<glm::dvec3>> hullsOf(const EyeMemory::Tool& tool) const;

    glm::dmat4 sceneToRoom_;
    scene::Look look_;
    glm::vec2 halfPicture_{};  // [pixel], of what is drawn now
    glm::vec3 sun_;            // towards it, of length 1
    float cellSize_;           // [scene unit]
    double probeUnit_;         // [scene unit]
    float toolRadius_;         // [scene unit], of the tool now
    sand::ToolShape toolShape_;
    sand::Heading toolHeading_;
    std::optional<EyeMemory::Tool> tool_;
    std::optional<ForceArrow> force_;
    lockstep::Overlays overlays_;
    bool culling_ = true;
    DrawCounts counts_;

    std::unique_ptr<DrawnSurface> surface_;
    SandPrograms sunlit_;
    std::optional<SandPrograms> hillShaded_;                     // since the layer was first drawn, as those below
    std::optional<SandPrograms> stampSunlit_, stampHillShaded_;  // since a tool was, that is no ball
    std::optional<GlProgram> stampWood_;
    std::optional<GlProgram> wireProgram_;
    std::optional<ForceArrowView> forceView_;
    GlProgram woodProgram_, toolProgram_;
    GrainTexture grain_;
    SandBox box_;
    ToolMesh toolMesh_;
};

}  // namespace render_node
