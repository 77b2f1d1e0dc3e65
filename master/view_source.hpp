// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string_view>

#include "lockstep/frame_message.hpp"
#include "lockstep/test_pattern.hpp"
#include "scene/model/scene.hpp"
#include "tracking/tracked_viewer.hpp"
#include "walls/orbit.hpp"
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
    void show(lockstep::Overlays layers) { state_.layers = layers; }
    void show(lockstep::Overlay layer, bool shown) { state_.layers.set(layer, shown); }
    [[nodiscard]] lockstep::Overlays layers() const { return state_.layers; }
    /// Shows the sand at this humidity, 0 to 1.
    void setHumidity(double humidity) { state_.humidity = humidity; }
    /// Turns the sand by a drag of the view [side of the window], right and down. Ignored unless the wall is a desktop.
    void turn(double right, double down);
    /// Turns the sand back to where the wall file has it.
    void turnBack();
    /// Calls TrackedViewer::separateEyes().
    void separateEyes(double metres) { viewer_.separateEyes(metres); }
    [[nodiscard]] double eyeSeparation() const { return state_.eyeSeparation; }  // [m], in the last view of at()
    [[nodiscard]] const tracking::TrackedViewer& viewer() const { return viewer_; }

private:
    void place(const walls::Orbit& orbit);

    tracking::TrackedViewer viewer_;
    lockstep::ViewState state_;
    walls::Stage stage_;
    glm::dvec3 field_;  // [scene unit], width and height of the field, and its reference height
    bool turns_;        // whether viewers may turn the sand
    walls::Orbit orbit_;
};

}  // namespace master
