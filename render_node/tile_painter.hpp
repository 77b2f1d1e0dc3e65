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
#include "render_node/overlay/text_panel.hpp"
#include "render_node/scene_painter.hpp"
#include "render_node/stereo_composer.hpp"
#include "render_node/tool/force.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"
#include "walls/wall.hpp"

namespace render_node {

/// Counts of the views of a tile, and of their pixels. A view is the picture of one eye in one frame.
struct ViewCounts {
    std::int64_t skipped = 0, inPart = 0, whole = 0;  // views that were not drawn, drawn in part, drawn whole
    std::int64_t pixelsDrawn = 0, pixels = 0;         // pixels in the drawn rectangles, pixels of all views

    /// Counts one view in `target`. `drawn` pixels of it were drawn.
    void add(std::int64_t drawn /* [pixel] */, const EyeTarget& target);
};

/// Returns the answer that the windows of a tile show: that of its rank, or otherwise that of the lowest row, if the
/// tile is in this row. Returns an empty text if it has none.
[[nodiscard]] std::string answerFor(const walls::Wall& wall, const walls::Tile& tile,
                                    std::span<const lockstep::Answer> answers);

/// Painter of one tile: draws the picture of each eye that the wall shows, and makes the pictures of the outputs.
///
/// All pixels follow from the wall, the sand and the frame's view alone, so that neighbouring tiles join. The GL
/// context must be current. Used by one thread.
class TilePainter {
public:
    /// `wall` and `tile` must outlive the painter. `start` is the sand of `scene` before the first step. Test patterns
    /// and statistics show `host`, the name of this machine. Throws std::runtime_error if a shader does not compile or
    /// if the driver refuses the size of a picture.
    TilePainter(const walls::Wall& wall, const walls::Tile& tile, const scene::Scene& scene, std::string host,
                const sand::SurfaceData& start);

    /// Changes the stereo mode or the size: `wall` and `tile` are the same wall and tile in another mode or with other
    /// pixels, on the same outputs. They must outlive the painter. Throws as the constructor does.
    void showAs(const walls::Wall& wall, const walls::Tile& tile);

    /// Makes the next paint() draw every eye whole. Called when the sand that was drawn may have been wrong.
    void drawAgain();
    /// Draws moving sand from now on as finely as sand at rest, or, as at first, more coarsely.
    void setSharp(bool sharp) { scenePainter_.setSharp(sharp); }

    /// Draws the parts of each eye's picture that changed, and composes the outputs. Does not wait for GL;
    /// GlContext::present() does. Throws std::runtime_error if a shader of an overlay or a test pattern does not
    /// compile.
    ///
    /// @param replica  Replica whose sand is drawn. Its list of changes is taken.
    /// @param view     Eyes and overlays of this frame. If it has a test pattern, the pattern is drawn instead.
    /// @param oneEye   With two eyes, draws only the eye of this frame: the left one in even frames, or in odd frames
    ///                 if the wall swaps eyes.
    /// @param figures  Figures that are shown over the sand if the view has Overlay::statistics.
    /// @param answers  Answers of this frame, of which the tile shows its own (answerFor()).
    void paint(sand::Replica& replica, const lockstep::ViewState& view, std::uint64_t frame, bool oneEye = false,
               const TileFigures& figures = {}, std::span<const lockstep::Answer> answers = {});
    /// Returns the picture of each output, in the order of tile.outputs. Valid until the next paint().
    [[nodiscard]] std::vector<OutputPicture> outputs() const { return composer_.shown(targets_); }
    /// Returns the pixels of the outputs that the last paint() may have changed.
    [[nodiscard]] const PixelRect& changed() const { return changed_; }

    /// Returns each eye's picture, in the order of walls::eyesOf(). If the output's picture is packed from both eyes,
    /// it comes last.
    [[nodiscard]] std::vector<const EyeTarget*> pictures() const;
    /// Returns the memory of all pictures on the graphics card [byte].
    [[nodiscard]] std::int64_t frameBufferBytes() const;
    /// Returns the counts of the sand's views so far. Test patterns and statistics do not count.
    [[nodiscard]] const ViewCounts& viewCounts() const { return counts_; }
    /// Returns the lowest and the highest height that any sand that was drawn has ever had.
    [[nodiscard]] shapes::HeightRange heightsEver() const { return scenePainter_.heightsEver(); }

private:
    struct EyeRange {
        std::size_t from, end;  // indices in targets_ of the first eye to paint, and after the last
    };
    [[nodiscard]] std::vector<Camera> camerasOf(const lockstep::ViewState& view) const;  // one for each eye
    // Both return the box around the pixels that changed in any eye.
    PixelRect paintSand(std::span<const Camera> cameras, EyeRange range);
    [[nodiscard]] PixelRect paintPattern(lockstep::Pattern pattern, std::uint64_t frame, EyeRange range);
    void uncover(EyeRange range);
    /// A panel over the sand, and for each target, whether it shows the panel.
    struct Still {
        std::optional<TextPanel> panel;
        std::vector<bool> drawn;
    };
    void showHelp(bool shown);
    void showAnswer(const std::string& text);
    /// Removes a panel. The next drawing restores the sand under it.
    void hide(Still& still);
    void paintStill(Still& still, EyeRange range, PixelRect& changed);
    void paintOverlay(EyeRange range);
    void compose(const PixelRect& changed);

    void makeTargets();

    const walls::Wall* wall_;
    const walls::Tile* tile_;
    std::string host_;
    sand::ForceConstants forceConstants_;
    ScenePainter scenePainter_;
    std::optional<ToolForce> force_;  // only while Overlay::force is shown
    std::vector<EyeTarget> targets_;
    std::vector<EyeMemory> memories_;  // for each target, what it shows
    StereoComposer composer_;
    std::optional<TestPatternView> patterns_;   // made when the first test pattern is shown
    std::vector<lockstep::Pattern> shown_;      // for each target, the pattern that it shows
    std::optional<StatisticsOverlay> overlay_;  // only while Overlay::statistics is shown
    std::vector<PixelRect> covered_;            // for each target, the pixels under the statistics
    std::optional<PanelPainter> panels_;        // made when the first panel is shown
    Still help_;                                // only while Overlay::help is shown, in the lowest row of tiles
    Still answer_;                              // only while there is an answer for this tile
    std::string answerText_;                    // that answer_ shows
    int answerBelow_ = 0;                       // [pixel], height of the help below it
    PixelRect changed_;                         // of the outputs, by the last paint()
    ViewCounts counts_;
};

}  // namespace render_node
