// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "haptic_bridge/loop/haptic_tick.hpp"
#include "haptic_bridge/loop/tick_track.hpp"
#include "sand/replica.hpp"
#include "scene/scene.hpp"

namespace haptic_bridge {

/// Recomputes the forces of a session from its tick track: the same hand, with a device that plays the track back, over
/// surfaces that a replica makes by replaying the steps.
class TickReplay {
public:
    /// `scene` outlives this. Throws base::FormatError for pieces that are none.
    TickReplay(const scene::Scene& scene, const std::vector<base::Bytes>& pieces);

    [[nodiscard]] bool empty() const { return pieces_.empty(); }
    /// Ticks the hand for as long as it felt the sand as it is now. Call it at the start and after every step.
    void feel(const sand::Replica& terrain, std::string& rows);
    /// Ticks that felt steps which the session did not keep, at its end.
    [[nodiscard]] std::size_t left() const;

private:
    class Player;
    void begin(const TrackPiece& piece);
    void tick(const TickInput& input, const sand::Replica& terrain, std::string& rows);

    const scene::Scene* scene_;
    std::deque<TrackPiece> pieces_;
    std::size_t next_ = 0;  // in the first piece
    std::uint32_t sitting_ = 0;
    std::unique_ptr<HapticTick> hand_;
    Player* player_ = nullptr;  // the hand's
    FeltSand surface_;
};

}  // namespace haptic_bridge
