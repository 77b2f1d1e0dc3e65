// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "haptic_bridge/client/client.hpp"
#include "haptic_bridge/hand/device_troubles.hpp"
#include "haptic_bridge/hand/hand.hpp"
#include "haptic_bridge/hand/hand_mapping.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"

namespace master {

/// Makes the paths of the master's own steps from the positions of the hand that a server without sand streams.
///
/// Lifts the tool if a position is implausible, or if the server has sent no position for kPatience. Used by one
/// thread. The scene must outlive this object.
class PositionSource : public haptic_bridge::Hand {
public:
    static constexpr double kPatience = 0.5;  // [s]
    // [hand space], longest plausible movement between two positions: a quarter of the field.
    static constexpr double kFarthest = 0.5;

    /// With a surface as `datum`, the first position unpacks the scene's heights.
    PositionSource(const scene::Scene& scene, haptic_bridge::HandSettings::Datum datum);

    /// Call it when a server begins to stream.
    void begin(const sand::Replica& sand) override;
    [[nodiscard]] bool streaming() const { return present(); }
    /// Adds the positions that have come since the last call.
    void add(const std::vector<haptic_bridge::TimedPosition>& positions, std::int64_t nowNs);
    /// Returns messages about wrong positions that are to be printed now. `floods` is the number of floods on the link
    /// so far.
    [[nodiscard]] std::vector<std::string> troubles(std::uint64_t floods, std::int64_t nowNs);

private:
    haptic_bridge::HandMapping mapping_;
    haptic_bridge::TroubleCounts counts_;
    haptic_bridge::TroubleReporter reporter_{"haptic link: the server"};
    std::optional<haptic_bridge::ReadingCheck> check_;
    std::int64_t heardNs_ = 0;
    std::uint64_t floods_ = 0;
};

}  // namespace master
