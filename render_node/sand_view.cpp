// SPDX-License-Identifier: Apache-2.0
#include "render_node/sand_view.hpp"

#include <cmath>

namespace render_node {
namespace {

constexpr double kToolReach = 6;     // [tool radius], beyond which light.glsl leaves the sky's light alone
constexpr double kLowestSun = 0.05;  // lower, and the tool's shadow may reach any tile

glm::vec3 toVector(const std::vector<double>& numbers) { return glm::dvec3(numbers[0], numbers[1], numbers[2]); }

/// sRGB from linear light, as the shaders' encode() does it but exact.
float encoded(float linear) {
    return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1 / 2.4F) - 0.055F;
}

}  // namespace

SandView::SandView(const sand::Scene& scene, const glm::dmat4& sceneToRoom)
    : sceneToRoom_(sceneToRoom),
      look_(scene.look),
      cellSize_(static_cast<float>(scene.terrain.cellSize())),
      toolRadius_(static_cast<float>(scene.toolRadius())),
      sandProgram_("sand.vert.glsl", "sand.frag.glsl"),
      sideProgram_("side.vert.glsl", "sand.frag.glsl"),
      woodProgram_("solid.vert.glsl", "wood.frag.glsl"),
      toolProgram_("solid.vert.glsl", "tool.frag.glsl"),
      grain_(glm::vec2(glm::normalize(toVector(look_.sunDirection)))),
      mesh_(scene.terrain),
      box_(mesh_.surface(), scene.rules.rim) {
    counts_.chunksOfField = mesh_.chunks();
}

void SandView::update(const sand::HeightField& field, sand::Rect damage) {
    const sand::Rect cells = damage.clippedTo(field.bounds());
    mesh_.update(field, cells);
    box_.update(mesh_.surface(), cells);
}

void SandView::setTool(sand::ProbePoint centre, bool engaged) {
    const glm::dvec3 cells = glm::dvec3(centre.x, centre.y, centre.z) / double{sand::kProbePerCell};
    tool_ = EyeMemory::Tool{glm::vec3(cells * double{cellSize_}), engaged};
}

void SandView::prepare(const GlProgram& program, const Camera& camera) const {
    program.use();
    program.set("uSceneToRoom", glm::mat4(sceneToRoom_));
    program.set("uRoomToClip", glm::mat4(camera.roomToClip));
    program.set("uEye", glm::vec3(glm::inverse(sceneToRoom_) * glm::dvec4(camera.eye, 1)));
    program.set("uSun", glm::normalize(toVector(look_.sunDirection)));
    program.set("uSand", toVector(look_.sandColour));
    program.set("uTool", tool_ ? glm::vec4(tool_->centre, toolRadius_) : glm::vec4(0));
    program.set("uGrain", 0);
    const double metresPerUnit = glm::length(glm::dvec3(sceneToRoom_[0]));
    program.set("uGrainScale", static_cast<float>(metresPerUnit / (kGrainSide * kGrainTexel)));
    program.set("uModel", glm::vec4(0, 0, 0, 1));
}

void SandView::draw(const Camera& camera, const EyeTarget& target) {
    target.bind();
    const glm::vec3 background = toVector(look_.backgroundColour);
    glClearColor(encoded(background.x), encoded(background.y), encoded(background.z), 1);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    grain_.bind(0);

    // Front to back as far as that is known: what is hidden is not shaded.
    if (tool_ && toolRadius_ > 0) {
        prepare(toolProgram_, camera);
        toolProgram_.set("uModel", glm::vec4(tool_->centre, toolRadius_));
        toolProgram_.set("uEngaged", tool_->engaged ? 1.0F : 0.0F);
        toolMesh_.draw();
    }
    prepare(sandProgram_, camera);
    sandProgram_.set("uCell", cellSize_);
    sandProgram_.set("uCells", glm::vec2(mesh_.surface().columns(), mesh_.surface().rows()));
    const SandMesh::Drawn drawn = mesh_.draw(camera.roomToClip * sceneToRoom_, culling_);
    counts_.chunks = drawn.chunks;
    counts_.triangles = drawn.triangles;

    prepare(sideProgram_, camera);
    box_.drawSides();
    prepare(woodProgram_, camera);
    box_.drawBoards();
}

bool SandView::toolInView(const std::optional<EyeMemory::Tool>& tool, const glm::dmat4& sceneToClip) const {
    if (!tool || toolRadius_ <= 0) {
        return false;
    }
    const glm::dvec3 sun = glm::normalize(toVector(look_.sunDirection));
    if (sun.z < kLowestSun) {
        return true;
    }
    // The ball, the dimmed sand around it, and its shadow down to the lowest sand there has been.
    const double radius = toolRadius_;
    const glm::dvec3 centre = tool->centre;
    const double along = std::max(0.0, centre.z - double{mesh_.lowestEver()}) / sun.z;
    const glm::dvec3 end = centre - along * sun;
    const double blurred = 1.2 * radius + 0.06 * along;
    const glm::dvec3 low = glm::min(centre - kToolReach * radius, end - blurred);
    const glm::dvec3 high = glm::max(centre + kToolReach * radius, end + blurred);
    // Light is interpolated between vertices: a cell more.
    return inFrustum({low - double{cellSize_}, high + double{cellSize_}}, sceneToClip);
}

bool SandView::same(const Camera& camera, const EyeMemory& memory) const {
    if (!memory.drawn || memory.roomToClip != camera.roomToClip || memory.eye != camera.eye ||
        memory.sceneToRoom != sceneToRoom_ || memory.sides != box_.revision()) {
        return false;
    }
    const glm::dmat4 sceneToClip = camera.roomToClip * sceneToRoom_;
    const bool toolMoved = memory.tool != tool_;
    return !(toolMoved && (toolInView(memory.tool, sceneToClip) || toolInView(tool_, sceneToClip))) &&
           !mesh_.changedInView(sceneToClip, memory.sand);
}

bool SandView::drawIfChanged(const Camera& camera, const EyeTarget& target, EyeMemory& memory) {
    const bool needed = !same(camera, memory);
    if (needed) {
        draw(camera, target);
    }
    memory = {true, camera.roomToClip, sceneToRoom_, camera.eye, mesh_.revision(), box_.revision(), tool_};
    return needed;
}

}  // namespace render_node
