// SPDX-License-Identifier: Apache-2.0
#include "render_node/tile_painter.hpp"

#include <glm/gtc/type_ptr.hpp>

#include "walls/projection.hpp"

namespace render_node {
namespace {

constexpr int kBytesPerPixel = 8;  // colour and depth

walls::Viewer viewerOf(const lockstep::ViewState& view) {
    return {
        {view.head[0], view.head[1], view.head[2]}, view.eyeSeparation, {view.right[0], view.right[1], view.right[2]}};
}

}  // namespace

TilePainter::TilePainter(const walls::Wall& wall, const walls::Tile& tile, const sand::Scene& scene)
    : wall_(wall), tile_(tile), sand_(scene, glm::dmat4(1)), memories_(walls::eyesOf(wall.stereo).size()) {
    for (std::size_t i = 0; i < memories_.size(); ++i) {
        targets_.emplace_back(tile.pixels.x, tile.pixels.y);
    }
}

void TilePainter::paint(sand::Terrain& terrain, const lockstep::ViewState& view) {
    sand_.setSceneToRoom(glm::make_mat4(view.sceneToRoom.data()));
    sand_.update(terrain.field(), terrain.takeDamage());
    if (terrain.stepNumber() > 0) {
        sand_.setTool(terrain.probe(), terrain.engaged());
    }
    const walls::Viewer viewer = viewerOf(view);
    std::size_t next = 0;
    for (const walls::Eye eye : walls::eyesOf(wall_.stereo)) {
        const glm::dvec3 position = walls::eyePosition(viewer, eye);
        const walls::View seen = walls::viewOf(tile_.screen, position, wall_.clip.near, wall_.clip.far);
        sand_.drawIfChanged({seen.viewProjection, position}, targets_[next], memories_[next]);
        ++next;
    }
}

std::vector<OutputPicture> TilePainter::outputs() { return {}; }

std::int64_t TilePainter::frameBufferBytes() const {
    std::int64_t bytes = 0;
    for (const EyeTarget& target : targets_) {
        bytes += std::int64_t{kBytesPerPixel} * target.width() * target.height();
    }
    return bytes;
}

}  // namespace render_node
