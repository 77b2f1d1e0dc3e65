// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "host/clock.hpp"
#include "tracking/head_tracker.hpp"
#include "walls/wall.hpp"

namespace tracking {

/// The viewer of a wall, frame by frame: the wall's own until a tracker tells more.
///
/// For the master alone, which sends what it says to every rank with the frame. One thread; at() never blocks. A pose
/// in which an eye is not in front of every screen has no picture: the last good one is held, which is said once.
class TrackedViewer {
public:
    /// Throws base::InputError when the tracker cannot be had.
    TrackedViewer(const walls::Wall& wall, const Source& source, Say say, Clock clock = host::monotonicNs);

    /// The viewer at this time of the session [s]: frame / refresh rate where every run must show the same, else the
    /// time since the first frame.
    [[nodiscard]] walls::Viewer at(double seconds);
    /// Moves the eyes this far apart [m], from now on. Throws base::InputError when one would not be in front of every
    /// screen, and nothing has changed.
    void separateEyes(double metres);
    [[nodiscard]] Counters counters() const;
    [[nodiscard]] bool tracked() const { return tracker_ != nullptr; }
    [[nodiscard]] std::uint16_t port() const { return tracker_ ? tracker_->port() : 0; }

    static constexpr double kNearestEye = 0.01;  // [m], to a screen's plane, as in a wall file

private:
    /// The first tile that an eye of this viewer is not in front of.
    [[nodiscard]] const walls::Tile* tileBehind(const walls::Viewer& viewer) const;

    std::vector<walls::Tile> tiles_;
    walls::Viewer viewer_;
    Say say_;
    std::unique_ptr<HeadTracker> tracker_;
    std::uint64_t outside_ = 0;
    bool isOutside_ = false;
    double outsideUntil_ = 0;  // [s]
};

}  // namespace tracking
