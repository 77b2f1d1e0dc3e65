// SPDX-License-Identifier: Apache-2.0
#include "render_node/scene_painter.hpp"

#include <cmath>
#include <functional>
#include <utility>

#include "render_node/surface_factory.hpp"
#include "render_node/tool/reach.hpp"
#include "shapes/model/colours.hpp"
#include "shapes/model/grain.hpp"
#include "shapes/tool/light.hpp"

namespace render_node {
namespace {

glm::vec3 toVector(const std::vector<double>& numbers) { return glm::dvec3(numbers[0], numbers[1], numbers[2]); }

}  // namespace

ScenePainter::ScenePainter(const scene::Scene& scene, const glm::dmat4& sceneToRoom)
    : ScenePainter(scene, scene.data(), sceneToRoom) {}

ScenePainter::ScenePainter(const scene::Scene& scene, const sand::SurfaceData& start, const glm::dmat4& sceneToRoom)
    : look_(scene.look),
      sun_(glm::normalize(toVector(scene.look.sunDirection))),
      cellSize_(scene.terrain.cellSize()),
      usualScale_(glm::length(glm::dvec3(sceneToRoom[0]))),
      tool_(scene.rules.tuning.tool),
      shown_{.sceneToRoom = sceneToRoom,
             .toolRadius = toolRadius(),
             .tool = {},
             .force = {},
             .layers = {},
             .humidity = scene.material.humidity,
             .sharp = false},
      surface_(makeDrawnSurface(start, scene.terrain.cellSize(), sun_, scene.rules.stepsPerSecond)),
      programs_(look_.flatShading),
      grain_(glm::vec2(sun_)),
      box_(std::make_unique<shapes::SandBox>(surface_->rim(), surface_->heightsEver().lowest,
                                             double{static_cast<float>(cellSize_)}, scene.rules.rim)),
      boxMesh_(*box_) {
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
        sceneToClips.push_back(camera.roomToClip * shown_.sceneToRoom);
    }
    if (surface_->update(data, change, sceneToClips)) {
        box_->update(surface_->rim());
        boxMesh_.update();
    }
}

void ScenePainter::setTool(sand::ProbePoint probe, bool engaged) {
    shown_.toolRadius = toolRadius();
    shown_.tool = shapes::DrawnTool::at(tool_, probe, engaged, cellSize_);
}

void ScenePainter::setTool(sand::ProbePoint probe, bool engaged, const sand::Tool& tool) {
    tool_ = tool;
    setTool(probe, engaged);
}

float ScenePainter::toolRadius() const { return shapes::DrawnTool::radiusOf(tool_, cellSize_); }

void ScenePainter::setLayers(lockstep::Overlays layers) {
    shown_.layers = {};
    for (const lockstep::Overlay layer : {lockstep::Overlay::wireframe, lockstep::Overlay::hillShade}) {
        shown_.layers.set(layer, layers.shows(layer));
    }
}

SandLight ScenePainter::sandLight() const {
    return shown_.layers.shows(lockstep::Overlay::hillShade) ? SandLight::hillShade
           : shown_.humidity > 0                             ? SandLight::wet
                                                             : SandLight::sunlit;
}

void ScenePainter::prepare(const GlProgram& program, const Pass& pass) const {
    const glm::dmat4& sceneToRoom = shown_.sceneToRoom;
    program.use();
    program.set("uSceneToRoom", glm::mat4(sceneToRoom));
    program.set("uRoomToClip", glm::mat4(pass.camera.roomToClip));
    program.set("uEye", glm::vec3(glm::inverse(sceneToRoom) * glm::dvec4(pass.camera.eye, 1)));
    program.set("uSceneToClip", glm::mat4(pass.camera.roomToClip * sceneToRoom));
    program.set("uHalfPicture", glm::vec2(pass.size) / 2.0F);
    program.set("uSun", sun_);
    program.set("uSand", shapes::wetAlbedo(toVector(look_.sandColour), shown_.humidity));
    program.set("uWet", static_cast<float>(shown_.humidity));
    prepareTool(program);
    program.set("uGrain", 0);
    program.set("uGrainScale", grainScale());
    program.set("uModel", glm::vec4(0, 0, 0, 1));
}

float ScenePainter::grainScale() const {
    // If the grain kept its size in the room, it would slide over the sand while the view is zoomed. So it grows with
    // the sand. Each time that the sand has doubled, the grain is halved. The wheel zooms by quarters of an octave. So
    // the border lies between two quarters, where rounding cannot decide. It is above the middle of the octave, because
    // grains that are finer than pixels fade.
    constexpr double kBetweenNotches = 0.375;
    const double octaves = std::log2(glm::length(glm::dvec3(shown_.sceneToRoom[0])) / usualScale_);
    return static_cast<float>(usualScale_ / (shapes::kGrainSide * shapes::kGrainTexel) *
                              std::exp2(std::floor(octaves + kBetweenNotches)));
}

void ScenePainter::prepareTool(const GlProgram& program) const {
    const shapes::ToolUniforms light = showsTool() ? uniformsOf(*shown_.tool, sun_) : shapes::ToolUniforms();
    program.set("uTool", light.tool);
    program.set("uToolSpace", light.space);
    program.set("uToolSun", light.sun);
    program.set("uToolStep", light.sunStep);
}

void ScenePainter::prepareSurface(const GlProgram& program, const Pass& pass) const {
    prepare(program, pass);
    surface_->prepare(program);
}

void ScenePainter::draw(const Camera& camera, const EyeTarget& target) {
    startCounting();
    drawWithin(allPixels({target.width(), target.height()}), camera, target);
}

void ScenePainter::drawWithin(const PixelRect& pixels, const Camera& camera, const EyeTarget& target) {
    const glm::ivec2 size(target.width(), target.height());
    const glm::dmat4 sceneToClip = camera.roomToClip * shown_.sceneToRoom;
    const Pass pass{camera, size, clipOf(pixels, size) * sceneToClip, ruleFor(camera, size)};
    counts_.pixels += pixels.area();
    target.bind();
    // The viewport stays that of the whole picture. With another viewport, edges would fall on other pixels.
    if (pixels.area() < std::int64_t{size.x} * size.y) {
        glEnable(GL_SCISSOR_TEST);
        glScissor(pixels.x0, pixels.y0, pixels.x1 - pixels.x0, pixels.y1 - pixels.y0);
    }
    const glm::vec3 background = shapes::encoded(toVector(look_.backgroundColour));
    glClearColor(background.x, background.y, background.z, 1);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    grain_.bind(0);

    // Draws roughly from front to back, because hidden pixels are not shaded.
    drawTool(pass);
    if (shown_.force) {
        drawForce(pass);
    }
    drawSand(pass);
    if (shown_.layers.shows(lockstep::Overlay::wireframe)) {
        drawWires(pass);
    }
    const GlProgram& wood = programs_.wood(hasBall());
    prepare(wood, pass);
    boxMesh_.drawBoards();
    wood.drawn();
    glDisable(GL_SCISSOR_TEST);
}

void ScenePainter::drawTool(const Pass& pass) {
    if (showsTool() && (!culling_ || shapes::inFrustum(shapes::bodyOf(*shown_.tool), pass.sceneToPart))) {
        const GlProgram& program = programs_.tool();
        prepare(program, pass);
        program.set("uModel", glm::vec4(shown_.tool->place, shown_.tool->radius));
        program.set("uEngaged", shown_.tool->engaged ? 1.0F : 0.0F);
        toolMesh_.show(shown_.tool->tool);
        toolMesh_.draw();
        program.drawn();
    }
}

void ScenePainter::drawForce(const Pass& pass) {
    if (!forceView_) {
        forceView_.emplace();
    }
    prepare(forceView_->program(), pass);
    forceView_->draw(*shown_.force, shown_.toolRadius);
}

void ScenePainter::drawSand(const Pass& pass) {
    const SandPrograms& programs = programs_.sand(hasBall(), sandLight());
    prepareSurface(programs.near, pass);
    prepareSurface(programs.far, pass);
    // The program `near` draws a shadow that is finer than the mesh. It costs a software renderer time at every pixel,
    // so that it is used only within the tool's reach.
    ProgramChoice choose;
    bool near = false;
    if (showsTool()) {
        choose = [&programs, &near,
                  reach = ToolReach(*shown_.tool, sun_)](const shapes::Box& chunk) -> const GlProgram& {
            const bool within = reach.meets(chunk);
            near = near || within;
            return within ? programs.near : programs.far;
        };
    }
    const DrawnSurface::Drawn drawn = surface_->draw(pass.sceneToPart, culling_, pass.rule, choose);
    (near ? programs.near : programs.far).drawn();
    counts_.chunks += drawn.chunks;
    counts_.coarseChunks += drawn.coarseChunks;
    counts_.triangles += drawn.triangles;

    prepare(programs.sides, pass);
    boxMesh_.drawSides(pass.sceneToPart, culling_);
    programs.sides.drawn();
}

void ScenePainter::drawWires(const Pass& pass) {
    prepareSurface(programs_.wires(), pass);
    glDepthFunc(GL_LEQUAL);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-1, -1);  // with a geometry shader, a driver may compute slightly different depths
    glEnable(GL_BLEND);
    // Keeps alpha, because the window system may use the window's alpha.
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    surface_->draw(pass.sceneToPart, culling_, pass.rule, {});
    surface_->drawMarks(pass.sceneToPart, culling_, [&](const GlProgram& program) { prepareSurface(program, pass); });
    glDisable(GL_BLEND);
    glDisable(GL_POLYGON_OFFSET_FILL);
    glDepthFunc(GL_LESS);
}

PixelRect ScenePainter::drawIfChanged(const Camera& camera, const EyeTarget& target, EyeMemory& memory) {
    startCounting();
    const glm::ivec2 size(target.width(), target.height());
    PixelRect changed;
    Redraw redraw(*surface_, *box_, sun_);
    for (const PixelRect& rect : redraw.pixels(camera, shown_, size, ruleFor(camera, size), memory)) {
        drawWithin(rect, camera, target);
        changed = around(changed, rect);
    }
    memory = {.drawn = true,
              .camera = camera,
              .scene = shown_,
              .sand = surface_->revision(),
              .levels = std::move(memory.levels),
              .covered = {}};
    return changed;
}

LevelRule ScenePainter::ruleFor(const Camera& camera, glm::ivec2 size) const {
    // With flat shading the size of the triangles is visible, so that all chunks have level 0.
    return {camera.roomToClip * shown_.sceneToRoom, size, look_.flatShading ? 0 : look_.detail,
            shown_.sharp ? 0 : pixelsPerQuad_};
}

}  // namespace render_node
