// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "haptic_bridge/client/client.hpp"
#include "haptic_bridge/hand/device_troubles.hpp"
#include "haptic_bridge/hand/hand_mapping.hpp"
#include "haptic_bridge/hand/path_builder.hpp"
#include "sand/replica.hpp"
#include "scene/scene.hpp"

namespace master {

/// Makes the paths of the master's own steps from what a server without sand streams: where its hand is.
///
/// A position that cannot be believed lifts the tool, and so does a server that has said nothing for kPatience. One
/// thread; the scene outlives it.
class PositionSource {
public:
    static constexpr double kPatience = 0.5;  // [s]
    static constexpr double kFarthest =
        0.5;  // [hand space], of a movement between two positions: a quarter of the field

    explicit PositionSource(const scene::Scene& scene);

    /// A server begins to stream; the tool is where the terrain has it.
    void begin(const sand::Replica& terrain);
    void end() { streaming_ = false; }
    [[nodiscard]] bool streaming() const { return streaming_; }

    void add(const std::vector<haptic_bridge::TimedPosition>& positions, std::int64_t nowNs);
    /// Fills in where the hand has been since the step before; a hovering tool while nobody streams.
    void fill(sand::Step& step);
    /// What a person should read now, of positions that were wrong.
    [[nodiscard]] std::vector<std::string> troubles(std::uint64_t floods, std::int64_t nowNs);

private:
    haptic_bridge::HandMapping mapping_;
    haptic_bridge::PathBuilder path_;
    haptic_bridge::TroubleCounts counts_;
    haptic_bridge::TroubleTeller teller_{"haptic link: the server"};
    std::optional<haptic_bridge::ReadingCheck> check_;
    sand::ProbePoint last_;
    std::int64_t heardNs_ = 0;
    std::uint64_t floods_ = 0;
    bool streaming_ = false, liftFirst_ = false;
};

}  // namespace master
