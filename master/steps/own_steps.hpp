// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "haptic_bridge/client/client.hpp"
#include "haptic_bridge/hand/pace.hpp"
#include "haptic_bridge/hand/pointer.hpp"
#include "haptic_bridge/hand/pointer_hand.hpp"
#include "master/steps/position_source.hpp"
#include "master/steps/step_source.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"

namespace master {

/// The steps that the master numbers itself: how many are due, and the path of their hand.
///
/// The hand is the pointer of the ranks' windows, or that of a server without sand that streams positions. Without a
/// hand the tool hovers. Used by one thread. The scene must outlive this object.
class OwnSteps {
public:
    OwnSteps(const scene::Scene& scene, haptic_bridge::Pace pace)
        : stepsPerSecond_(scene.rules.stepsPerSecond), pace_(pace), positions_(scene) {}

    /// Call it when the master begins to number the steps.
    void begin(std::int64_t nowNs) {
        owed_ = 0;
        lastNs_ = nowNs;
    }
    /// Returns how many steps are due since the last call. The caller makes them, or leaves them out.
    [[nodiscard]] std::size_t due(std::int64_t nowNs);
    /// Fills in the hand's path since the step before, and when it was read. The path keeps within `limit`. `nowNs` is
    /// the present time on the host's clock [ns].
    void fill(haptic_bridge::TimedStep& own, const haptic_bridge::SubstepLimit& limit, std::int64_t nowNs);

    /// Takes the positions of the server, if the link is in the state `streaming`. Prints troubles with them.
    void followPositions(haptic_bridge::Client& client, haptic_bridge::Link link, const sand::Replica& sand,
                         std::int64_t nowNs);
    /// Takes the pointers and the depth of their tool [tool radius]. From the first call on they are the hand.
    void pointed(std::span<const haptic_bridge::PointerReport> reports, double depth, const sand::Replica& sand,
                 std::int64_t receivedNs);

    /// Returns whether a server streams positions.
    [[nodiscard]] bool streaming() const { return positions_.streaming(); }
    /// Returns whether the pointers are the hand.
    [[nodiscard]] bool hasPointer() const { return pointer_.has_value(); }
    /// Returns whether a pointer has moved or touched.
    [[nodiscard]] bool pointerMoved() const { return pointer_ && pointer_->pointed(); }

private:
    int stepsPerSecond_;
    haptic_bridge::Pace pace_;
    PositionSource positions_;
    std::optional<haptic_bridge::PointerHand> pointer_;  // nullopt before pointed()
    std::int64_t pointedNs_ = 0;                         // [ns], when the last reports arrived
    double owed_ = 0;                                    // [step]
    std::int64_t lastNs_ = 0;
};

}  // namespace master
