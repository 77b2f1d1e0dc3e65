// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lockstep/frame_message.hpp"
#include "render_node/gl/eye_target.hpp"
#include "render_node/gl/gl_context.hpp"
#include "render_node/overlay/statistics.hpp"
#include "render_node/overlay/test_pattern.hpp"
#include "render_node/scene_painter.hpp"
#include "render_node/stereo_composer.hpp"
#include "render_node/tool/force.hpp"
#include "sand/replica.hpp"
#include "scene/scene.hpp"
#include "walls/wall.hpp"

namespace render_node {

/// What has been drawn of the eyes of a tile: a view is one eye in one frame.
struct ViewCounts {
    std::int64_t skipped = 0, inPart = 0, whole = 0;
    std::int64_t pixelsDrawn = 0, pixels = 0;  // in rectangles that were drawn; of all views

    void add(std::int64_t drawn /* [pixel] */, const EyeTarget& target);
};

/// Draws one tile: an eye target for each eye that the wall shows, and what its outputs make of them.
///
/// Everything follows from the wall, the sand and the frame's view, so that tiles join. Needs its context current; one
/// thread.
class TilePainter {
public:
    /// `wall` and `tile` must outlive it; test patterns show the host. `start` is the sand of a replica of the scene
    /// that has made no step. Throws std::runtime_error when a shader does not compile or a size is refused.
    TilePainter(const walls::Wall& wall, const walls::Tile& tile, const scene::Scene& scene, std::string host,
                const sand::SurfaceData& start);

    /// From now on as another stereo mode of the same wall, on the same outputs. `wall` and `tile` must outlive it.
    void showAs(const walls::Wall& wall, const walls::Tile& tile);

    /// Has the next paint() draw every eye whole: what was drawn of the sand cannot be trusted.
    void drawAnew();

    /// Brings every eye that differs up to date with `terrain` as `view` sees it, or with its test pattern, and puts
    /// them together; with `oneEye` only that which the frame shows, the left one in even frames. `figures` are shown
    /// over the sand where the view has Overlay::statistics. Does not wait for GL.
    void paint(sand::Replica& terrain, const lockstep::ViewState& view, std::uint64_t frame, bool oneEye = false,
               const TileFigures& figures = {});
    /// What each output shows, in the order of tile.outputs; good until the next paint().
    [[nodiscard]] std::vector<OutputPicture> outputs() const { return composer_.shown(targets_); }

    /// Each eye's picture, in the order of walls::eyesOf, and behind them the output's where it is made of both.
    [[nodiscard]] std::vector<const EyeTarget*> pictures() const;
    [[nodiscard]] std::int64_t frameBufferBytes() const;
    /// Of the sand, so far; test patterns and statistics do not count.
    [[nodiscard]] const ViewCounts& viewCounts() const { return counts_; }

private:
    struct EyeRange {
        std::size_t from, end;  // of the eyes that are painted, as indices of targets_
    };
    [[nodiscard]] std::vector<Camera> camerasOf(const lockstep::ViewState& view) const;  // by eye
    // The pixels that have changed in some eye.
    PixelRect paintSand(std::span<const Camera> cameras, EyeRange range);
    [[nodiscard]] PixelRect paintPattern(lockstep::Pattern pattern, std::uint64_t frame, EyeRange range);
    void uncover(EyeRange range);
    void paintOverlay(EyeRange range);

    void makeTargets();

    const walls::Wall* wall_;
    const walls::Tile* tile_;
    std::string host_;
    sand::ForceConstants forceConstants_;
    ScenePainter scenePainter_;
    std::optional<ToolForce> force_;  // while its layer is shown
    std::vector<EyeTarget> targets_;
    std::vector<EyeMemory> memories_;  // what each target shows already
    StereoComposer composer_;
    std::optional<TestPatternView> patterns_;   // since one was asked for
    std::vector<lockstep::Pattern> shown_;      // by each target
    std::optional<StatisticsOverlay> overlay_;  // while it is shown
    std::vector<PixelRect> covered_;            // of each target, by the overlay
    ViewCounts counts_;
};

}  // namespace render_node
