// SPDX-License-Identifier: Apache-2.0
#include "render_node/scene_painter.hpp"

#include <cmath>
#include <functional>

#include "render_node/surface_factory.hpp"

namespace render_node {
namespace {

const glm::vec4 kNoTool(0, 0, 1e9, 1);  // too far away to take any light

glm::vec3 toVector(const std::vector<double>& numbers) { return glm::dvec3(numbers[0], numbers[1], numbers[2]); }

/// Converts linear light to sRGB exactly; the shaders' encode() is an approximation. The result is a whole level,
/// because a driver may clear a part of a picture by another path than the whole. The two paths may round differently.
float encoded(float linear) {
    const float level = linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1 / 2.4F) - 0.055F;
    return std::round(255 * level) / 255;
}

}  // namespace

ScenePainter::ScenePainter(const scene::Scene& scene, const glm::dmat4& sceneToRoom)
    : ScenePainter(scene, scene.data(), sceneToRoom) {}

ScenePainter::ScenePainter(const scene::Scene& scene, const sand::SurfaceData& start, const glm::dmat4& sceneToRoom)
    : sceneToRoom_(sceneToRoom),
      look_(scene.look),
      sun_(glm::normalize(toVector(scene.look.sunDirection))),
      cellSize_(scene.terrain.cellSize()),
      tool_(scene.rules.tuning.tool),
      surface_(makeDrawnSurface(start, scene.terrain.cellSize(), sun_)),
      sunlit_(shaders(), "sunlit.glsl", "ball.glsl"),
      woodProgram_("solid.vert.glsl", "wood.frag.glsl"),
      toolProgram_("solid.vert.glsl", "tool.frag.glsl"),
      grain_(glm::vec2(sun_)),
      box_(surface_->rim(), surface_->heightsEver().lowest, double{static_cast<float>(cellSize_)}, scene.rules.rim) {
    startCounting();
}

void ScenePainter::startCounting() {
    counts_ = {};
    counts_.chunksOfField = surface_->chunks();
}

void ScenePainter::update(const sand::SurfaceData& data, const sand::SurfaceChange& change,
                          std::span<const Camera> cameras) {
    std::vector<glm::dmat4> sceneToClips;
    for (const Camera& camera : cameras) {
        sceneToClips.push_back(camera.roomToClip * sceneToRoom_);
    }
    if (surface_->update(data, change, sceneToClips)) {
        box_.update(surface_->rim());
    }
}

SurfaceShaders ScenePainter::shaders() const {
    return look_.flatShading ? SurfaceShaders{"facet.vert.glsl", "facet.geom.glsl"} : SurfaceShaders{"sand.vert.glsl"};
}

void ScenePainter::setTool(sand::ProbePoint centre, bool engaged) {
    const glm::dvec3 cells = glm::dvec3(centre.x, centre.y, centre.z) / double{sand::kProbePerCell};
    drawnTool_ = DrawnTool{tool_, glm::vec3(cells * double{static_cast<float>(cellSize_)}), toolRadius(), engaged};
}

void ScenePainter::setTool(sand::ProbePoint centre, bool engaged, const sand::Tool& tool) {
    tool_ = tool;
    setTool(centre, engaged);
}

float ScenePainter::toolRadius() const { return static_cast<float>(tool_.radius * cellSize_ / sand::kProbePerCell); }

void ScenePainter::setLayers(lockstep::Overlays layers) {
    overlays_ = {};
    for (const lockstep::Overlay layer : {lockstep::Overlay::wireframe, lockstep::Overlay::hillShade}) {
        overlays_.set(layer, layers.shows(layer));
    }
}

void ScenePainter::prepare(const GlProgram& program, const Camera& camera) const {
    program.use();
    program.set("uSceneToRoom", glm::mat4(sceneToRoom_));
    program.set("uRoomToClip", glm::mat4(camera.roomToClip));
    program.set("uEye", glm::vec3(glm::inverse(sceneToRoom_) * glm::dvec4(camera.eye, 1)));
    program.set("uSceneToClip", glm::mat4(camera.roomToClip * sceneToRoom_));
    program.set("uHalfPicture", halfPicture_);
    program.set("uSun", sun_);
    program.set("uSand", toVector(look_.sandColour));
    prepareTool(program);
    program.set("uGrain", 0);
    const double metresPerUnit = glm::length(glm::dvec3(sceneToRoom_[0]));
    program.set("uGrainScale", static_cast<float>(metresPerUnit / (kGrainSide * kGrainTexel)));
    program.set("uModel", glm::vec4(0, 0, 0, 1));
}

void ScenePainter::prepareTool(const GlProgram& program) const {
    if (!drawnTool_ || !(drawnTool_->radius > 0)) {
        program.set("uTool", kNoTool);
    } else if (drawnTool_->isBall()) {
        program.set("uTool", glm::vec4(drawnTool_->centre, 1 / drawnTool_->radius));
    } else {
        const ToolLight light(*drawnTool_);
        const glm::dvec3 sun = light.toBall * glm::dvec3(sun_);
        program.set("uTool", glm::vec4(glm::vec3(light.centre), 1));
        program.set("uToolSpace", glm::mat3(light.toBall));
        program.set("uToolSun", glm::vec3(glm::normalize(sun)));
        program.set("uToolStep", static_cast<float>(1 / (glm::length(sun) * light.radius)));
    }
}

void ScenePainter::prepareSurface(const GlProgram& program, const Camera& camera) const {
    prepare(program, camera);
    surface_->prepare(program);
}

Box ScenePainter::bodyOf(const DrawnTool& tool) {
    const Box box = boxOfTool(tool.tool);
    return {glm::dvec3(tool.centre) + double{tool.radius} * box.low,
            glm::dvec3(tool.centre) + double{tool.radius} * box.high};
}

void ScenePainter::draw(const Camera& camera, const EyeTarget& target) {
    startCounting();
    drawWithin(allPixels({target.width(), target.height()}), camera, target);
}

void ScenePainter::drawWithin(const PixelRect& pixels, const Camera& camera, const EyeTarget& target) {
    const glm::ivec2 size(target.width(), target.height());
    const glm::dmat4 sceneToClip = camera.roomToClip * sceneToRoom_;
    const glm::dmat4 sceneToPart = clipOf(pixels, size) * sceneToClip;
    halfPicture_ = glm::vec2(size) / 2.0F;
    counts_.pixels += pixels.area();
    target.bind();
    // The viewport stays that of the whole picture. With another viewport, edges would fall on other pixels.
    if (pixels.area() < std::int64_t{size.x} * size.y) {
        glEnable(GL_SCISSOR_TEST);
        glScissor(pixels.x0, pixels.y0, pixels.x1 - pixels.x0, pixels.y1 - pixels.y0);
    }
    const glm::vec3 background = toVector(look_.backgroundColour);
    glClearColor(encoded(background.x), encoded(background.y), encoded(background.z), 1);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    grain_.bind(0);

    // Draws roughly from front to back, because hidden pixels are not shaded.
    drawTool(camera, sceneToPart);
    if (force_) {
        drawForce(camera);
    }
    const LevelRule rule = ruleFor(camera, size);
    drawSand(camera, sceneToPart, rule);
    if (overlays_.shows(lockstep::Overlay::wireframe)) {
        drawWires(camera, sceneToPart, rule);
    }
    const GlProgram& wood = woodProgram();
    prepare(wood, camera);
    box_.drawBoards();
    wood.drawn();
    glDisable(GL_SCISSOR_TEST);
}

void ScenePainter::drawTool(const Camera& camera, const glm::dmat4& sceneToPart) {
    if (drawnTool_ && drawnTool_->radius > 0 && (!culling_ || inFrustum(bodyOf(*drawnTool_), sceneToPart))) {
        prepare(toolProgram_, camera);
        toolProgram_.set("uModel", glm::vec4(drawnTool_->centre, drawnTool_->radius));
        toolProgram_.set("uEngaged", drawnTool_->engaged ? 1.0F : 0.0F);
        toolMesh_.show(drawnTool_->tool);
        toolMesh_.draw();
        toolProgram_.drawn();
    }
}

void ScenePainter::drawForce(const Camera& camera) {
    if (!forceView_) {
        forceView_.emplace();
    }
    prepare(forceView_->program(), camera);
    forceView_->draw(*force_, toolRadius());
}

const SandPrograms& ScenePainter::sandPrograms() {
    const bool hillShade = overlays_.shows(lockstep::Overlay::hillShade);
    const bool ball = !drawnTool_ || drawnTool_->isBall();
    if (ball && !hillShade) {
        return sunlit_;
    }
    std::optional<SandPrograms>& programs = ball ? hillShaded_ : hillShade ? stampHillShaded_ : stampSunlit_;
    if (!programs) {
        programs.emplace(shaders(), hillShade ? "hill_shade.glsl" : "sunlit.glsl", ball ? "ball.glsl" : "stamp.glsl");
    }
    return *programs;
}

const GlProgram& ScenePainter::woodProgram() {
    if (!drawnTool_ || drawnTool_->isBall()) {
        return woodProgram_;
    }
    if (!stampWood_) {
        stampWood_.emplace(ProgramFiles{"solid.vert.glsl", "wood.frag.glsl", {}, {}, "stamp.glsl"});
    }
    return *stampWood_;
}

void ScenePainter::drawSand(const Camera& camera, const glm::dmat4& sceneToPart, const LevelRule& rule) {
    const SandPrograms& programs = sandPrograms();
    prepareSurface(programs.near, camera);
    prepareSurface(programs.far, camera);
    // The program `near` draws a shadow that is finer than the mesh. It costs a software renderer time at every pixel,
    // so that it is used only within the tool's reach.
    std::function<void(const Box&)> choose;
    bool near = false;
    if (drawnTool_ && drawnTool_->radius > 0) {
        choose = [&programs, &near, reach = reachOf(*drawnTool_)](const Box& chunk) {
            const bool within = reach.meets(chunk);
            (within ? programs.near : programs.far).use();
            near = near || within;
        };
    }
    const DrawnSurface::Drawn drawn = surface_->draw(sceneToPart, culling_, rule, choose);
    (near ? programs.near : programs.far).drawn();
    counts_.chunks += drawn.chunks;
    counts_.coarseChunks += drawn.coarseChunks;
    counts_.triangles += drawn.triangles;

    prepare(programs.sides, camera);
    box_.drawSides(sceneToPart, culling_);
    programs.sides.drawn();
}

void ScenePainter::drawWires(const Camera& camera, const glm::dmat4& sceneToPart, const LevelRule& rule) {
    if (!wireProgram_) {
        wireProgram_.emplace(ProgramFiles{"sand.vert.glsl", "wire.frag.glsl", "sunlit.glsl", "wire.geom.glsl"});
    }
    prepareSurface(*wireProgram_, camera);
    glDepthFunc(GL_LEQUAL);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-1, -1);  // with a geometry shader, a driver may compute slightly different depths
    glEnable(GL_BLEND);
    // Keeps alpha, because the window system may use the window's alpha.
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    surface_->draw(sceneToPart, culling_, rule, {});
    surface_->drawMarks(sceneToPart, culling_, [&](const GlProgram& program) { prepareSurface(program, camera); });
    glDisable(GL_BLEND);
    glDisable(GL_POLYGON_OFFSET_FILL);
    glDepthFunc(GL_LESS);
}

LevelRule ScenePainter::ruleFor(const Camera& camera, glm::ivec2 size) const {
    // With flat shading the size of the triangles is visible, so that all chunks have level 0.
    return {camera.roomToClip * sceneToRoom_, size, look_.flatShading ? 0 : look_.detail};
}

}  // namespace render_node
