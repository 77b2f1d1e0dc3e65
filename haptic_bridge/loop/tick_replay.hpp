// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "haptic_bridge/loop/haptic_tick.hpp"
#include "haptic_bridge/loop/tick_track.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"

namespace haptic_bridge {

/// Recomputation of the forces of a session from its tick track. It runs the same HapticTick, with a device that plays
/// the track back. A replica that replays the steps gives the surfaces.
class TickReplay {
public:
    /// `scene` must outlive this object. Throws base::FormatError if `pieces` are not pieces of a tick track.
    TickReplay(const scene::Scene& scene, const std::vector<base::Bytes>& pieces);

    [[nodiscard]] bool empty() const { return pieces_.empty(); }
    /// Runs the ticks that felt the sand as it is now, and appends their rows to `rows`. Call it at the start and after
    /// every step.
    void feel(const sand::Replica& replica, std::string& rows);
    /// Returns how many ticks are left at the end, because they felt steps that the session did not keep.
    [[nodiscard]] std::size_t left() const;

private:
    class Player;
    void begin(const TrackPiece& piece);
    void tick(const TickInput& input, const sand::Replica& replica, std::string& rows);

    const scene::Scene* scene_;
    std::deque<TrackPiece> pieces_;
    std::size_t next_ = 0;  // index of the next tick in the first piece
    std::uint32_t sitting_ = 0;
    std::unique_ptr<HapticTick> hand_;
    Player* player_ = nullptr;  // device of hand_
    FeltSand surface_;
};

}  // namespace haptic_bridge
