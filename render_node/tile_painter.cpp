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

TilePainter::TilePainter(const walls::Wall& wall, const walls::Tile& tile, const sand::Scene& scene, std::string host)
    : wall_(wall),
      tile_(tile),
      host_(std::move(host)),
      sand_(scene, glm::dmat4(1)),
      memories_(walls::eyesOf(wall.stereo).size()),
      composer_(wall.stereo, tile) {
    for (std::size_t i = 0; i < memories_.size(); ++i) {
        targets_.emplace_back(tile.pixels.x, tile.pixels.y);
    }
}

void TilePainter::paint(sand::Terrain& terrain, const lockstep::ViewState& view, std::uint64_t frame) {
    sand_.setSceneToRoom(glm::make_mat4(view.sceneToRoom.data()));
    sand_.update(terrain.field(), terrain.takeDamage());
    if (terrain.stepNumber() > 0) {
        sand_.setTool(terrain.probe(), terrain.engaged());
    }
    const auto pattern = static_cast<lockstep::Pattern>(view.pattern);
    const bool changed = pattern == lockstep::Pattern::none ? paintSand(view) : paintPattern(pattern, frame);
    shown_ = pattern;
    if (changed) {
        composer_.compose(targets_);
    }
}

bool TilePainter::paintSand(const lockstep::ViewState& view) {
    const walls::Viewer viewer = viewerOf(view);
    bool changed = false;
    std::size_t next = 0;
    for (const walls::Eye eye : walls::eyesOf(wall_.stereo)) {
        const glm::dvec3 position = walls::eyePosition(viewer, eye);
        const walls::View seen = walls::viewOf(tile_.screen, position, wall_.clip.near, wall_.clip.far);
        changed |= sand_.drawIfChanged({seen.viewProjection, position}, targets_[next], memories_[next]);
        ++next;
    }
    return changed;
}

bool TilePainter::paintPattern(lockstep::Pattern pattern, std::uint64_t frame) {
    if (pattern == shown_ && !lockstep::changesEveryFrame(pattern)) {
        return false;
    }
    if (!patterns_) {
        patterns_.emplace(wall_, tile_, host_);
    }
    std::size_t next = 0;
    for (const walls::Eye eye : walls::eyesOf(wall_.stereo)) {
        patterns_->draw(pattern, eye, frame, targets_[next]);
        memories_[next].drawn = false;  // the sand must come back whole
        ++next;
    }
    return true;
}

std::int64_t TilePainter::frameBufferBytes() const {
    std::int64_t bytes = composer_.bytes();
    for (const EyeTarget& target : targets_) {
        bytes += std::int64_t{kBytesPerPixel} * target.width() * target.height();
    }
    return bytes;
}

}  // namespace render_node
