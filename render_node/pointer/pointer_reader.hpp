// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "haptic_bridge/hand/pointer.hpp"
#include "haptic_bridge/hand/touched_sand.hpp"
#include "lockstep/frame_message.hpp"
#include "render_node/gl/gl_platform.hpp"
#include "render_node/pointer/window_ray.hpp"
#include "sand/replica.hpp"
#include "shapes/model/height_range.hpp"
#include "walls/wall.hpp"

namespace render_node {

/// Makes the report that a rank sends with its arrival from the pointer's events in its windows.
///
/// A ray from the midpoint of the eyes through the pointer meets the rank's own sand. While the pointer is pressed, the
/// sand from before the stroke counts, because otherwise the tool would sink into its own furrow. Used by one thread.
class PointerReader {
public:
    /// `wall` is the wall as it is shown. It must outlive the reader, and may change to another stereo mode.
    PointerReader(const walls::Wall& wall, int rank) : wall_(wall), rank_(rank) {}

    /// Returns the report of `events`. All places are computed with `view` and with the sand of `replica`, which are
    /// those of the frame that is drawn.
    ///
    /// @param heights  No height of the sand is outside of these [scene unit].
    /// @param clockAhead  This rank's clock − master's clock [ns].
    [[nodiscard]] haptic_bridge::PointerReport read(std::span<const PointerEvent> events, const sand::Replica& replica,
                                                    const lockstep::ViewState& view, shapes::HeightRange heights,
                                                    std::int64_t clockAhead);

private:
    /// A place of the pointer, before its ray is computed.
    struct Reading {
        std::int64_t ns = 0;
        WindowPlace place{};
        bool pressed = false;
    };
    /// The sand and the view of a read().
    struct Shown {
        const sand::Replica& replica;
        const lockstep::ViewState& view;
        shapes::HeightRange heights;
    };
    enum class Drag : std::uint8_t { none, turn, pan };

    void follow(const PointerEvent& event, haptic_bridge::PointerReport& report);
    void followView(const Shown& shown, haptic_bridge::PointerReport& report);
    [[nodiscard]] const walls::Tile& tile() const { return wall_.tiles.at(static_cast<std::size_t>(rank_ - 1)); }
    /// Returns the sight through a place in a window [cell], from the field's south-west corner.
    [[nodiscard]] haptic_bridge::Ray sight(const WindowPlace& place, const Shown& shown) const;
    /// Returns the point of the room [m] that a place in a window shows at `depth` [m] from the eye.
    [[nodiscard]] glm::dvec3 pointAt(const WindowPlace& place, double depth, const lockstep::ViewState& view) const;
    /// Returns the distance from the eye, across the screen, of the sand at a place in a window [m]. Beside the sand,
    /// returns that of the middle of the stage.
    [[nodiscard]] double depthAt(const WindowPlace& place, const Shown& shown) const;

    const walls::Wall& wall_;
    int rank_;
    std::vector<Reading> readings_;  // since the report before
    Reading before_;                 // the last one of that report
    WindowPlace last_;
    bool pressed_ = false;
    Drag drag_ = Drag::none;                      // of the view
    std::optional<WindowPlace> wheeled_;          // of the wheel's last turn since the report before
    std::optional<WindowPlace> panFrom_, panTo_;  // part of a pan that no report has
    std::optional<double> panDepth_;              // [m], of the point that is dragged; nullopt: not computed yet
    std::uint32_t touches_ = 0;
    haptic_bridge::TouchedSand touched_;
};

}  // namespace render_node
