// SPDX-License-Identifier: Apache-2.0
#include "render_node/sand_view.hpp"

#include <algorithm>
#include <cmath>

namespace render_node {
namespace {

constexpr double kToolReach = 6;     // [tool radius], beyond which light.glsl leaves the sky's light alone
constexpr double kLowestSun = 0.05;  // lower, and the tool's shadow may reach any tile
constexpr double kMostOfAll = 0.8;   // of a picture: a rectangle larger than that costs as much as the whole

glm::vec3 toVector(const std::vector<double>& numbers) { return glm::dvec3(numbers[0], numbers[1], numbers[2]); }

/// sRGB from linear light, as the shaders' encode() does it but exact. A whole level: part of a picture may be cleared
/// by another way through the driver than all of it, and these need not round alike.
float encoded(float linear) {
    const float level = linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1 / 2.4F) - 0.055F;
    return std::round(255 * level) / 255;
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

Box SandView::ballOf(const EyeMemory::Tool& tool) const {
    const double radius = 1.01 * double{toolRadius_};  // more, for what GL's floats may round
    return {glm::dvec3(tool.centre) - radius, glm::dvec3(tool.centre) + radius};
}

void SandView::draw(const Camera& camera, const EyeTarget& target) {
    drawWithin({0, 0, target.width(), target.height()}, camera, target);
}

void SandView::drawWithin(const PixelRect& pixels, const Camera& camera, const EyeTarget& target) {
    const glm::ivec2 size(target.width(), target.height());
    const glm::dmat4 sceneToClip = camera.roomToClip * sceneToRoom_;
    const glm::dmat4 sceneToPart = clipOf(pixels, size) * sceneToClip;
    target.bind();
    // The viewport stays the whole picture's: with another one, edges would fall on other pixels.
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

    // Front to back as far as that is known: what is hidden is not shaded.
    if (tool_ && toolRadius_ > 0 && (!culling_ || inFrustum(ballOf(*tool_), sceneToPart))) {
        prepare(toolProgram_, camera);
        toolProgram_.set("uModel", glm::vec4(tool_->centre, toolRadius_));
        toolProgram_.set("uEngaged", tool_->engaged ? 1.0F : 0.0F);
        toolMesh_.draw();
        toolProgram_.drawn();
    }
    prepare(sandProgram_, camera);
    sandProgram_.set("uCell", cellSize_);
    sandProgram_.set("uCells", glm::vec2(mesh_.surface().columns(), mesh_.surface().rows()));
    const SandMesh::Drawn drawn = mesh_.draw(sceneToPart, culling_);
    sandProgram_.drawn();
    counts_.chunks = drawn.chunks;
    counts_.triangles = drawn.triangles;

    prepare(sideProgram_, camera);
    box_.drawSides(sceneToPart, culling_);
    sideProgram_.drawn();
    prepare(woodProgram_, camera);
    box_.drawBoards();
    woodProgram_.drawn();
    glDisable(GL_SCISSOR_TEST);
}

/// What a tool changes, as convex hulls: itself with the sand that it dims, and its shadow.
std::vector<std::vector<glm::dvec3>> SandView::reachOf(const EyeMemory::Tool& tool) const {
    const double radius = toolRadius_;
    const double cell = cellSize_;  // light is interpolated between vertices: a cell more everywhere
    const glm::dvec3 centre = tool.centre;
    const HeightRange sand = mesh_.heightsEver();
    // High above everything, its ball of dimmed places meets little of it, or nothing.
    const double above = std::max(0.0, centre.z - std::max(double{sand.highest}, box_.highest()));
    const double reach = kToolReach * radius;
    const double wide = std::max(radius, std::sqrt(std::max(0.0, reach * reach - above * above))) + cell;
    Box dimmed{centre - glm::dvec3(wide, wide, reach), centre + glm::dvec3(wide, wide, reach)};
    dimmed.low.z = std::min(centre.z - radius, std::max(dimmed.low.z, double{sand.lowest})) - cell;
    dimmed.high.z = std::max(centre.z + radius, std::min(dimmed.high.z, double{sand.highest})) + cell;

    const glm::dvec3 sun = glm::normalize(toVector(look_.sunDirection));
    const auto shadowDownTo = [&](double lowest) {
        const double along = std::max(0.0, centre.z - lowest) / sun.z;
        const double blurred = 1.2 * radius + 0.06 * along + cell;
        return Box{centre - along * sun - blurred, centre - along * sun + blurred};
    };
    const Box start{centre - 1.2 * radius - cell, centre + 1.2 * radius + cell};
    // Down to the lowest sand there has been, unless it comes out again beyond the rim: nothing stops it in the
    // shaders.
    const Box deepest = shadowDownTo(std::min(double{sand.lowest}, box_.lowest()));
    const Box end = box_.insideRim(deepest) ? shadowDownTo(double{sand.lowest}) : deepest;

    std::vector<std::vector<glm::dvec3>> hulls(2);
    const auto add = [](std::vector<glm::dvec3>& hull, const Box& box) {
        for (const glm::dvec3& corner : cornersOf(box)) {
            hull.push_back(corner);
        }
    };
    add(hulls[0], box_.withSides(dimmed));
    add(hulls[1], box_.withSides(start));
    add(hulls[1], box_.withSides(end));
    return hulls;
}

PixelRect SandView::changedPixels(const Camera& camera, glm::ivec2 size, const EyeMemory& memory) const {
    const PixelRect whole{0, 0, size.x, size.y};
    const bool toolMoved = memory.tool != tool_;
    const bool longShadows = toolRadius_ > 0 && glm::normalize(toVector(look_.sunDirection)).z < kLowestSun;
    if (!memory.drawn || memory.roomToClip != camera.roomToClip || memory.eye != camera.eye ||
        memory.sceneToRoom != sceneToRoom_ || (toolMoved && longShadows)) {
        return whole;
    }
    const glm::dmat4 sceneToClip = camera.roomToClip * sceneToRoom_;
    PixelRect changed;
    const auto add = [&](std::span<const glm::dvec3> hull) {
        changed = around(changed, pixelsOf(hull, sceneToClip, size));
    };
    if (toolMoved && toolRadius_ > 0) {
        for (const std::optional<EyeMemory::Tool>& tool : {memory.tool, tool_}) {
            if (tool) {
                std::ranges::for_each(reachOf(*tool), add);
            }
        }
    }
    for (const SandDamage::Part& part : mesh_.damageSince(memory.sand)) {
        add(cornersOf(box_.withSides(part.box)));
    }
    return static_cast<double>(changed.area()) > kMostOfAll * static_cast<double>(whole.area()) ? whole : changed;
}

PixelRect SandView::drawIfChanged(const Camera& camera, const EyeTarget& target, EyeMemory& memory) {
    const PixelRect changed = changedPixels(camera, {target.width(), target.height()}, memory);
    if (!changed.empty()) {
        drawWithin(changed, camera, target);
    }
    memory = {true, camera.roomToClip, sceneToRoom_, camera.eye, mesh_.revision(), tool_};
    return changed;
}

}  // namespace render_node
