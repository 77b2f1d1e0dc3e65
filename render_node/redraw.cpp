// SPDX-License-Identifier: Apache-2.0
#include "render_node/redraw.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "render_node/tool/reach.hpp"
#include "shapes/tool/mesh.hpp"

namespace render_node {
namespace {

constexpr double kMostOfAll = 0.8;  // share of a picture; larger rectangles cost as much as the whole picture
// Fixed cost of drawing a rectangle (buffers, programs, chunks), measured for llvmpipe by redraw_bench [pixel].
constexpr std::int64_t kPass = 4096;
constexpr std::size_t kMostPasses = 4;  // each pass tests every chunk

}  // namespace

/// Returns convex hulls around everything that a tool changes: the sand that it dims, its shadow, and the tool.
std::vector<std::vector<glm::dvec3>> Redraw::hullsOf(const shapes::DrawnTool& tool) const {
    const ToolReach reach(tool, sun_);
    const shapes::HeightRange sand = surface_.heightsEver();
    const double highest = std::max(double{sand.highest}, box_.highest());
    // A shadow inside the rim ends at the lowest sand that there has been. A shadow that leaves the rim ends at the
    // lowest point of the box, because nothing in the shaders stops it.
    std::array<shapes::Box, 2> shadow = reach.shadowBetween(std::min(double{sand.lowest}, box_.lowest()), highest);
    if (box_.insideRim(shadow.back())) {
        shadow = reach.shadowBetween(double{sand.lowest}, highest);
    }
    std::vector<std::vector<glm::dvec3>> hulls(2);
    const auto add = [this](std::vector<glm::dvec3>& hull, const shapes::Box& box) {
        for (const glm::dvec3& corner : shapes::cornersOf(box_.withSides(box))) {
            hull.push_back(corner);
        }
    };
    add(hulls[0], reach.closeBy(double{sand.lowest}, highest));
    std::ranges::for_each(shadow, [&](const shapes::Box& box) { add(hulls[1], box); });
    const auto body = shapes::cornersOf(shapes::bodyOf(tool));
    hulls.emplace_back(body.begin(), body.end());
    return hulls;
}

std::vector<PixelRect> Redraw::pixels(const Camera& camera, const ShownScene& scene, glm::ivec2 size,
                                      const LevelRule& rule, EyeMemory& memory) {
    const PixelRect whole = allPixels(size);
    const glm::dmat4 sceneToClip = camera.roomToClip * scene.sceneToRoom;
    const ShownScene& before = memory.scene;
    if (!memory.drawn || memory.camera != camera || before.sceneToRoom != scene.sceneToRoom ||
        before.layers != scene.layers || before.humidity != scene.humidity ||
        (before.sharp != scene.sharp && surface_.moves())) {
        memory.levels = surface_.levelsWithin(sceneToClip, rule);
        return {whole};
    }
    std::vector<PixelRect> changed{memory.covered};
    const auto add = [&](std::span<const glm::dvec3> hull) { changed.push_back(pixelsOf(hull, sceneToClip, size)); };
    if (before.tool != scene.tool && scene.toolRadius > 0) {
        for (const std::optional<shapes::DrawnTool>& tool : {before.tool, scene.tool}) {
            if (tool) {
                std::ranges::for_each(hullsOf(*tool), add);
            }
        }
    }
    if (before.force != scene.force) {
        if (before.force && before.tool) {
            add(shapes::cornersOf(boxOf(*before.force, before.tool->radius)));
        }
        if (scene.force) {
            add(shapes::cornersOf(boxOf(*scene.force, scene.toolRadius)));
        }
    }
    for (const shapes::Box& box : surface_.changesSince(memory.sand, memory.levels, rule)) {
        add(shapes::cornersOf(box_.withSides(box)));
    }
    changed = fewCovering(std::move(changed), kMostPasses, kPass);
    std::int64_t area = 0;
    for (const PixelRect& rect : changed) {
        area += rect.area();
    }
    return static_cast<double>(area) > kMostOfAll * static_cast<double>(whole.area()) ? std::vector{whole} : changed;
}

}  // namespace render_node
