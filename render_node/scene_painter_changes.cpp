// SPDX-License-Identifier: Apache-2.0
// Computes the parts of an eye's picture that must be drawn again.
#include <algorithm>

#include "render_node/scene_painter.hpp"

namespace render_node {
namespace {

constexpr double kMostOfAll = 0.8;  // share of a picture; larger rectangles cost as much as the whole picture
// Fixed cost of drawing a rectangle (buffers, programs, chunks), measured for llvmpipe by redraw_bench [pixel].
constexpr std::int64_t kPass = 4096;
constexpr std::size_t kMostPasses = 4;  // each pass tests every chunk

}  // namespace

ToolReach ScenePainter::reachOf(const DrawnTool& tool) const {
    const ToolLight light(tool);
    return {light.centre, light.radius, sun_};
}

/// Returns convex hulls around everything that a tool changes: the sand that it dims, its shadow, and the tool.
std::vector<std::vector<glm::dvec3>> ScenePainter::hullsOf(const DrawnTool& tool) const {
    const ToolReach reach = reachOf(tool);
    const HeightRange sand = surface_->heightsEver();
    const double highest = std::max(double{sand.highest}, box_.highest());
    // A shadow inside the rim ends at the lowest sand that there has been. A shadow that leaves the rim ends at the
    // lowest point of the box, because nothing in the shaders stops it.
    std::array<Box, 2> shadow = reach.shadowBetween(std::min(double{sand.lowest}, box_.lowest()), highest);
    if (box_.insideRim(shadow.back())) {
        shadow = reach.shadowBetween(double{sand.lowest}, highest);
    }
    std::vector<std::vector<glm::dvec3>> hulls(2);
    const auto add = [this](std::vector<glm::dvec3>& hull, const Box& box) {
        for (const glm::dvec3& corner : cornersOf(box_.withSides(box))) {
            hull.push_back(corner);
        }
    };
    add(hulls[0], reach.closeBy(double{sand.lowest}, highest));
    std::ranges::for_each(shadow, [&](const Box& box) { add(hulls[1], box); });
    const auto body = cornersOf(bodyOf(tool));
    hulls.emplace_back(body.begin(), body.end());
    return hulls;
}

std::vector<PixelRect> ScenePainter::changedPixels(const Camera& camera, glm::ivec2 size, EyeMemory& memory) {
    const PixelRect whole = allPixels(size);
    const glm::dmat4 sceneToClip = camera.roomToClip * sceneToRoom_;
    const LevelRule rule = ruleFor(camera, size);
    const bool toolMoved = memory.tool != drawnTool_;
    if (!memory.drawn || memory.roomToClip != camera.roomToClip || memory.eye != camera.eye ||
        memory.sceneToRoom != sceneToRoom_ || memory.layers != overlays_) {
        memory.levels = surface_->levelsWithin(sceneToClip, rule);
        return {whole};
    }
    std::vector<PixelRect> changed{memory.covered};
    const auto add = [&](std::span<const glm::dvec3> hull) { changed.push_back(pixelsOf(hull, sceneToClip, size)); };
    if (toolMoved && toolRadius() > 0) {
        for (const std::optional<DrawnTool>& tool : {memory.tool, drawnTool_}) {
            if (tool) {
                std::ranges::for_each(hullsOf(*tool), add);
            }
        }
    }
    if (memory.force != force_) {
        if (memory.force && memory.tool) {
            add(cornersOf(boxOf(*memory.force, memory.tool->radius)));
        }
        if (force_) {
            add(cornersOf(boxOf(*force_, toolRadius())));
        }
    }
    for (const Box& box : surface_->changesSince(memory.sand, memory.levels, rule)) {
        add(cornersOf(box_.withSides(box)));
    }
    changed = fewCovering(std::move(changed), kMostPasses, kPass);
    std::int64_t area = 0;
    for (const PixelRect& rect : changed) {
        area += rect.area();
    }
    return static_cast<double>(area) > kMostOfAll * static_cast<double>(whole.area()) ? std::vector{whole} : changed;
}

PixelRect ScenePainter::drawIfChanged(const Camera& camera, const EyeTarget& target, EyeMemory& memory) {
    startCounting();
    PixelRect changed;
    for (const PixelRect& rect : changedPixels(camera, {target.width(), target.height()}, memory)) {
        drawWithin(rect, camera, target);
        changed = around(changed, rect);
    }
    memory = {true,
              camera.roomToClip,
              sceneToRoom_,
              camera.eye,
              surface_->revision(),
              std::move(memory.levels),
              drawnTool_,
              force_,
              overlays_,
              {}};
    return changed;
}

}  // namespace render_node
