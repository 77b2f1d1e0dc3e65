// SPDX-License-Identifier: Apache-2.0
#include "tracking/tracked_viewer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/input_error.hpp"
#include "walls/projection.hpp"

namespace tracking {
namespace {

constexpr double kPause = 1;  // [s], time without a pose outside, before the next pose outside is reported

}  // namespace

TrackedViewer::TrackedViewer(const walls::Wall& wall, const Source& source, Print print, Clock clock)
    : tiles_(wall.tiles),
      viewer_(wall.viewer),
      print_(print),
      tracker_(openTracker(source, wall.viewer.eye, std::move(print), std::move(clock))) {}

const walls::Tile* TrackedViewer::tileBehind(const walls::Viewer& viewer) const {
    const auto tile = std::find_if(tiles_.begin(), tiles_.end(), [&](const walls::Tile& one) {
        return !(one.screen.distanceTo(walls::eyePosition(viewer, walls::Eye::left)) >= kNearestEye &&
                 one.screen.distanceTo(walls::eyePosition(viewer, walls::Eye::right)) >= kNearestEye);
    });
    return tile == tiles_.end() ? nullptr : &*tile;
}

walls::Viewer TrackedViewer::at(double seconds) {
    const std::optional<Pose> pose = tracker_ ? tracker_->newest(seconds) : std::nullopt;
    if (!pose) {
        return viewer_;
    }
    walls::Viewer moved = viewer_;
    moved.eye = pose->position;
    moved.right = pose->right;
    if (const walls::Tile* tile = tileBehind(moved)) {
        ++outside_;
        if (!isOutside_) {
            print_(
                fmt::format("head tracking: the head at ({:.2f}, {:.2f}, {:.2f}) is not in front of tile '{}'; the "
                            "last place is held",
                            moved.eye.x, moved.eye.y, moved.eye.z, tile->name));
        }
        isOutside_ = true;
        outsideUntil_ = seconds;
        return viewer_;
    }
    if (isOutside_ && seconds > outsideUntil_ + kPause) {
        isOutside_ = false;
        print_("head tracking: the head is in front of every tile again");
    }
    return viewer_ = moved;
}

void TrackedViewer::separateEyes(double metres) {
    walls::Viewer wider = viewer_;
    wider.eyeSeparation = metres;
    if (const walls::Tile* tile = tileBehind(wider)) {
        throw base::InputError(fmt::format(
            "with eyes {} m apart, one is not in front of tile '{}'; bring them closer together", metres, tile->name));
    }
    viewer_ = wider;
}

Counters TrackedViewer::counters() const {
    Counters counters = tracker_ ? tracker_->counters() : Counters{};
    counters.outside = outside_;
    return counters;
}

}  // namespace tracking
