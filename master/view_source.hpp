// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "lockstep/frame_message.hpp"
#include "lockstep/test_pattern.hpp"
#include "scene/scene.hpp"
#include "tracking/tracked_viewer.hpp"
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
    /// Calls TrackedViewer::separateEyes().
    void separateEyes(double metres) { viewer_.separateEyes(metres); }
    [[nodiscard]] double eyeSeparation() const { return state_.eyeSeparation; }  // [m], in the last view of at()
    [[nodiscard]] const tracking::TrackedViewer& viewer() const { return viewer_; }

private:
    tracking::TrackedViewer viewer_;
    lockstep::ViewState state_;
};

}  // namespace master
