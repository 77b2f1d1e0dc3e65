// SPDX-License-Identifier: Apache-2.0
#include "render_node/tile_painter.hpp"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>

#include "render_node/overlay/help.hpp"
#include "scene/model/scene.hpp"
#include "walls/projection.hpp"

namespace render_node {
namespace {

walls::Viewer viewerOf(const lockstep::ViewState& view) {
    return {
        {view.head[0], view.head[1], view.head[2]}, view.eyeSeparation, {view.right[0], view.right[1], view.right[2]}};
}

/// Returns where the wall file has the sand, before anybody moves the view.
glm::dmat4 stagedAt(const walls::Wall& wall, const scene::Scene& scene) {
    const double cell = scene.terrain.cellSize();
    return walls::stageToRoom(wall.stage, scene.rules.columns * cell, scene.rules.rows * cell,
                              scene.referenceHeight() * scene.terrain.unit());
}

}  // namespace

std::string answerFor(const walls::Wall& wall, const walls::Tile& tile, std::span<const lockstep::Answer> answers) {
    if (answers.empty()) {
        return {};
    }
    const auto of = [&](int rank) {
        const auto found = std::ranges::find(answers, rank, &lockstep::Answer::rank);
        return found == answers.end() ? std::string() : found->text;
    };
    const std::string own = of(tile.rank);
    return own.empty() && helpPlaceOf(wall, tile) ? of(0) : own;
}

void ViewCounts::add(std::int64_t drawn, const EyeTarget& target) {
    const std::int64_t all = std::int64_t{target.width()} * target.height();
    (drawn == 0 ? skipped : drawn < all ? inPart : whole) += 1;
    pixelsDrawn += drawn;
    pixels += all;
}

TilePainter::TilePainter(const walls::Wall& wall, const walls::Tile& tile, const scene::Scene& scene, std::string host,
                         const sand::SurfaceData& start)
    : wall_(&wall),
      tile_(&tile),
      host_(std::move(host)),
      forceConstants_(scene.force),
      scenePainter_(scene, start, stagedAt(wall, scene)),
      composer_(wall.stereo, tile) {
    makeTargets();
}

void TilePainter::makeTargets() {
    const std::size_t eyes = walls::eyesOf(wall_->stereo).size();
    targets_.clear();
    for (std::size_t i = 0; i < eyes; ++i) {
        targets_.emplace_back(tile_->pixels.x, tile_->pixels.y);
    }
    memories_.assign(eyes, {});
    shown_.assign(eyes, lockstep::Pattern::none);
    covered_.assign(eyes, {});
    help_.drawn.assign(eyes, false);
    answer_.drawn.assign(eyes, false);
}

void TilePainter::showAs(const walls::Wall& wall, const walls::Tile& tile) {
    wall_ = &wall;
    tile_ = &tile;
    makeTargets();
    composer_ = StereoComposer(wall.stereo, tile);
    patterns_.reset();
    overlay_.reset();
    help_.panel.reset();
    answer_.panel.reset();
    answerText_.clear();
}

void TilePainter::drawAgain() {
    memories_.assign(memories_.size(), {});
    shown_.assign(shown_.size(), lockstep::Pattern::none);
}

void TilePainter::paint(sand::Replica& replica, const lockstep::ViewState& view, std::uint64_t frame, bool oneEye,
                        const TileFigures& figures, std::span<const lockstep::Answer> answers) {
    scenePainter_.setLayers(view.layers);
    scenePainter_.setHumidity(view.humidity);
    scenePainter_.setSceneToRoom(glm::make_mat4(view.sceneToRoom.data()));
    const std::vector<Camera> cameras = camerasOf(view);
    scenePainter_.update(replica.surface().data(), replica.takeChange(), cameras);
    if (replica.probe() != sand::ProbePoint{}) {  // a hand has moved the tool
        scenePainter_.setTool(replica.probe(), replica.engaged(), replica.tool());
    }
    if (!view.layers.shows(lockstep::Overlay::force)) {
        force_.reset();
    } else if (!force_) {
        force_.emplace(forceConstants_);
    }
    scenePainter_.setForce(force_ ? force_->arrow(replica) : std::nullopt);
    const std::size_t shownEye = (frame + (wall_->swapEyes ? 1 : 0)) % targets_.size();
    const EyeRange range = oneEye ? EyeRange{shownEye, shownEye + 1} : EyeRange{0, targets_.size()};
    const auto pattern = static_cast<lockstep::Pattern>(view.pattern);
    if (!view.layers.shows(lockstep::Overlay::statistics)) {
        overlay_.reset();
        uncover(range);
    } else {
        if (!overlay_) {
            overlay_.emplace(*wall_, *tile_, host_);
        }
        overlay_->add(figures, frame);
    }
    showHelp(view.layers.shows(lockstep::Overlay::help));
    showAnswer(answerFor(*wall_, *tile_, answers));
    PixelRect changed =
        pattern == lockstep::Pattern::none ? paintSand(cameras, range) : paintPattern(pattern, frame, range);
    std::fill(shown_.begin() + static_cast<std::ptrdiff_t>(range.from),
              shown_.begin() + static_cast<std::ptrdiff_t>(range.end), pattern);
    changed_ = {};
    compose(changed);
    if (overlay_ && pattern == lockstep::Pattern::none) {
        paintOverlay(range);
        changed = around(changed, overlay_->pixels());
    }
    if (pattern == lockstep::Pattern::none) {
        paintStill(help_, range, changed);
        paintStill(answer_, range, changed);
    }
}

void TilePainter::showHelp(bool shown) {
    if (!shown) {
        hide(help_);
    } else if (!help_.panel) {
        if (const auto place = helpPlaceOf(*wall_, *tile_)) {
            const Sheet sheet = helpSheet(*place, tile_->pixels);
            help_.panel.emplace(sheet, glm::ivec2(0, tile_->pixels.y - sheet.size().y), tile_->pixels.y);
        }
    }
}

void TilePainter::showAnswer(const std::string& text) {
    const int below = help_.panel ? help_.panel->pixels().y1 : 0;
    if (text != answerText_ || below != answerBelow_) {
        hide(answer_);
        answerText_ = text;
        answerBelow_ = below;
        if (!text.empty()) {
            const Sheet sheet = answerSheet(tile_->pixels, text);
            answer_.panel.emplace(sheet, answerCorner(tile_->pixels, sheet.size(), below), tile_->pixels.y);
        }
    }
}

void TilePainter::hide(Still& still) {
    for (std::size_t i = 0; still.panel && i < still.drawn.size(); ++i) {
        memories_[i].covered = around(memories_[i].covered, still.drawn[i] ? still.panel->pixels() : PixelRect{});
    }
    still.drawn.assign(targets_.size(), false);
    still.panel.reset();
}

/// Composes the outputs where the eyes have changed.
void TilePainter::compose(const PixelRect& changed) {
    changed_ = around(changed_, composer_.compose(targets_, changed));
}

/// Draws a panel again where anything has been drawn over it, because still sand must cost nothing. Adds its pixels to
/// `changed`, because a later panel may cover them.
void TilePainter::paintStill(Still& still, EyeRange range, PixelRect& changed) {
    if (!still.panel) {
        return;
    }
    if (!panels_) {
        panels_.emplace();
    }
    const PixelRect before = changed;
    for (std::size_t i = range.from; i < range.end; ++i) {
        const PixelRect lost = still.drawn[i] ? overlap(before, still.panel->pixels()) : still.panel->pixels();
        if (!lost.empty()) {
            panels_->draw(*still.panel, targets_[i]);
            still.drawn[i] = true;
            compose(lost);
            changed = around(changed, still.panel->pixels());
        }
    }
}

/// Makes the next drawing restore the sand under the overlay.
void TilePainter::uncover(EyeRange range) {
    for (std::size_t i = range.from; i < range.end; ++i) {
        memories_[i].covered = around(memories_[i].covered, covered_[i]);
        covered_[i] = {};
    }
}

void TilePainter::paintOverlay(EyeRange range) {
    overlay_->draw(std::span<const EyeTarget>(targets_).subspan(range.from, range.end - range.from));
    for (std::size_t i = range.from; i < range.end; ++i) {
        covered_[i] = overlay_->pixels();
    }
    compose(overlay_->pixels());
}

std::vector<Camera> TilePainter::camerasOf(const lockstep::ViewState& view) const {
    const walls::Viewer viewer = viewerOf(view);
    std::vector<Camera> cameras;
    for (const walls::Eye eye : walls::eyesOf(wall_->stereo)) {
        const glm::dvec3 position = walls::eyePosition(viewer, eye);
        const walls::View seen = walls::viewOf(tile_->screen, position, wall_->clip.near, wall_->clip.far);
        cameras.push_back({seen.viewProjection, position});
    }
    return cameras;
}

PixelRect TilePainter::paintSand(std::span<const Camera> cameras, EyeRange range) {
    PixelRect changed;
    for (std::size_t i = range.from; i < range.end; ++i) {
        const PixelRect drawn = scenePainter_.drawIfChanged(cameras[i], targets_[i], memories_[i]);
        counts_.add(scenePainter_.counts().pixels, targets_[i]);
        changed = around(changed, drawn);
    }
    return changed;
}

PixelRect TilePainter::paintPattern(lockstep::Pattern pattern, std::uint64_t frame, EyeRange range) {
    if (!patterns_) {
        patterns_.emplace(*wall_, *tile_, host_);
    }
    PixelRect changed;
    for (std::size_t i = range.from; i < range.end; ++i) {
        if (shown_[i] != pattern || lockstep::changesEveryFrame(pattern)) {
            patterns_->draw(pattern, walls::eyesOf(wall_->stereo)[i], frame, targets_[i]);
            memories_[i].drawn = false;  // the sand must be drawn whole after the pattern
            covered_[i] = {};
            help_.drawn[i] = answer_.drawn[i] = false;
            changed = allPixels({targets_[i].width(), targets_[i].height()});
        }
    }
    return changed;
}

std::vector<const EyeTarget*> TilePainter::pictures() const {
    std::vector<const EyeTarget*> all;
    for (const EyeTarget& target : targets_) {
        all.push_back(&target);
    }
    if (walls::packsEyes(wall_->stereo)) {
        all.push_back(outputs().front().picture);
    }
    return all;
}

std::int64_t TilePainter::frameBufferBytes() const {
    std::int64_t bytes = composer_.bytes();
    for (const EyeTarget& target : targets_) {
        bytes += target.bytes();
    }
    return bytes;
}

}  // namespace render_node
