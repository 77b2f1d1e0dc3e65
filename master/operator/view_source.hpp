// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "haptic_bridge/hand/pointer.hpp"
#include "lockstep/frame_message.hpp"
#include "lockstep/test_pattern.hpp"
#include "sand/model/surface.hpp"
#include "scene/model/scene.hpp"
#include "tracking/tracked_viewer.hpp"
#include "walls/desk_view.hpp"
#include "walls/wall.hpp"

namespace master {

/// Source of each frame's view. A view has the eyes of the wall file's viewer or of a tracked head, and the place of
/// the sand in the room. It also has the test pattern or the overlays.
class ViewSource {
public:
    /// Throws base::InputError if the tracker cannot be opened.
    ViewSource(const walls::Wall& wall, const scene::Scene& scene, const tracking::Source& source);

    /// Returns the view at the session's time `seconds` [s].
    [[nodiscard]] lockstep::ViewState at(double seconds);

    void show(lockstep::Pattern pattern) { state_.pattern = static_cast<std::uint8_t>(pattern); }
    [[nodiscard]] lockstep::Pattern pattern() const { return static_cast<lockstep::Pattern>(state_.pattern); }
    void show(walls::Stereo stereo) { state_.stereo = static_cast<std::uint8_t>(stereo); }
    void swapEyes(bool swapEyes) { state_.swapEyes = swapEyes; }
    /// Sets the size of the window that the picture follows [pixel].
    void show(glm::ivec2 window) { state_.window = {window.x, window.y}; }
    void show(lockstep::Overlays layers) { state_.layers = layers; }
    void show(lockstep::Overlay layer, bool shown) { state_.layers.set(layer, shown); }
    [[nodiscard]] lockstep::Overlays layers() const { return state_.layers; }
    /// Shows the sand at this humidity, 0 to 1.
    void setHumidity(double humidity) { state_.humidity = humidity; }
    /// Returns whether people may move the view: the wall is a desktop, and no tracker moves the viewer.
    [[nodiscard]] bool moves() const { return desk_.has_value(); }
    /// Moves the view as the pointer of `report` has dragged it, and zooms by its wheel. Returns false if the wheel
    /// turned beyond a limit of the zoom. Requires moves().
    bool move(const haptic_bridge::PointerReport& report);
    /// Frames the terrain with its boards and its floor (walls::DeskView::frame). Its sand has the heights `sand`. The
    /// floor stays below the lowest sand of all calls, because ranks draw it where it was at the start. Ignored unless
    /// moves().
    void frame(const sand::HeightSpan& sand);
    /// Shows the sand as another session on this wall did. Throws base::InputError unless moves().
    void show(const walls::Orbit& orbit);
    /// Returns the view to which people have moved the sand, or nullopt unless moves().
    [[nodiscard]] std::optional<walls::Orbit> orbit() const {
        return desk_ ? std::optional(desk_->orbit()) : std::nullopt;
    }
    /// Calls TrackedViewer::separateEyes().
    void separateEyes(double metres) { viewer_.separateEyes(metres); }
    [[nodiscard]] double eyeSeparation() const { return state_.eyeSeparation; }  // [m], in the last view of at()
    [[nodiscard]] const tracking::TrackedViewer& viewer() const { return viewer_; }

private:
    void place(const glm::dmat4& sceneToRoom);

    tracking::TrackedViewer viewer_;
    lockstep::ViewState state_;
    walls::StagedField field_;
    double unit_;                          // [scene unit], size of a height unit
    std::optional<double> floorOf_;        // [scene unit], lowest sand of all calls of frame()
    std::optional<walls::DeskView> desk_;  // nullopt unless people may move the view
};

}  // namespace master
