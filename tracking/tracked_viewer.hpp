// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "host/clock.hpp"
#include "tracking/head_tracker.hpp"
#include "walls/wall.hpp"

namespace tracking {

/// Viewer of a wall, frame by frame. Until a tracker sends a pose, it is the wall file's viewer.
///
/// Only the master uses it; it sends the viewer to every rank with the frame. Used by one thread. at() never blocks. If
/// an eye would not be in front of every screen, the last good pose is kept, and this is reported once.
class TrackedViewer {
public:
    /// Throws base::InputError if the tracker cannot be opened.
    TrackedViewer(const walls::Wall& wall, const Source& source, Print print, Clock clock = host::monotonicNs);

    /// Returns the viewer at this time of the session [s]. The time is frame / refresh rate if every run must show the
    /// same, otherwise the time since the first frame.
    [[nodiscard]] walls::Viewer at(double seconds);
    /// Sets the distance between the eyes [m] for all further frames. Throws base::InputError if an eye would not be in
    /// front of every screen; the distance is then unchanged.
    void separateEyes(double metres);
    [[nodiscard]] Counters counters() const;
    [[nodiscard]] bool tracked() const { return tracker_ != nullptr; }
    [[nodiscard]] std::uint16_t port() const { return tracker_ ? tracker_->port() : 0; }

    static constexpr double kNearestEye = 0.01;  // [m], least distance to a screen's plane, as in a wall file

private:
    /// Returns the first tile that an eye of this viewer is not in front of, or null.
    [[nodiscard]] const walls::Tile* tileBehind(const walls::Viewer& viewer) const;

    std::vector<walls::Tile> tiles_;
    walls::Viewer viewer_;
    Print print_;
    std::unique_ptr<HeadTracker> tracker_;
    std::uint64_t outside_ = 0;
    bool isOutside_ = false;
    double outsideUntil_ = 0;  // [s]
};

}  // namespace tracking
