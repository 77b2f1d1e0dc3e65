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

/// Behaviour of a session while sand and hand are at rest. It makes steps if its steps are counted.
enum class AtRest : std::uint8_t { makesSteps, makesNone };

/// The steps that the master numbers itself: how many are due, and the path of their hand.
///
/// The hand is the pointer of the ranks' windows, or that of a server without sand that streams positions. Without a
/// hand the tool hovers. Used by one thread. The scene must outlive this object.
class OwnSteps {
public:
    /// Time for which sand and hand have been at rest when the last step is made [s]. In a large field more steps
    /// follow, until all of the sand is drawn as sand at rest (shapes::Sharpening).
    static constexpr double kRestAfter = 1;

    /// Under the fast pace, `atRest` has no effect: each frame has a step.
    /// Only with a server may positions come.
    OwnSteps(const scene::Scene& scene, haptic_bridge::Pace pace, AtRest atRest, bool hasServer)
        : stepsPerSecond_(scene.rules.stepsPerSecond),
          pace_(pace),
          atRest_(atRest),
          positions_(scene, hasServer ? haptic_bridge::HandSettings::Datum::surface
                                      : haptic_bridge::HandSettings::Datum::level) {}

    /// Call it when the master begins to number the steps.
    void begin(std::int64_t nowNs) {
        owed_ = 0;
        lastNs_ = movedNs_ = nowNs;
        rests_ = false;
    }
    /// Returns how many steps are due since the last call. The caller makes them, or leaves them out. `edited` is
    /// whether an edit waits. After a rest, the first movement of the hand and the first edit are due at once.
    [[nodiscard]] std::size_t due(std::int64_t nowNs, const sand::Replica& sand, bool edited);
    /// Returns whether no step is due, because sand and hand are at rest.
    [[nodiscard]] bool rests() const { return rests_; }
    /// Fills in the hand's path since the step before, and when it was read. The path keeps within `limit`. `nowNs` is
    /// the present time on the host's clock [ns].
    void fill(ArrivedStep& own, const haptic_bridge::SubstepLimit& limit, std::int64_t nowNs);

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
    [[nodiscard]] haptic_bridge::Hand& hand() {
        return pointer_ ? static_cast<haptic_bridge::Hand&>(*pointer_) : positions_;
    }
    /// Returns whether a step that is made now would change more than its number.
    [[nodiscard]] bool wouldChange(const sand::Replica& sand, bool edited);
    [[nodiscard]] bool drawnAsResting(const sand::Replica& sand) const;
    void followRest(std::int64_t nowNs, bool changes, const sand::Replica& sand);

    int stepsPerSecond_;
    haptic_bridge::Pace pace_;
    AtRest atRest_;
    PositionSource positions_;
    std::optional<haptic_bridge::PointerHand> pointer_;  // nullopt before pointed()
    std::int64_t pointedNs_ = 0;                         // [ns], when the last reports arrived
    double owed_ = 0;                                    // [step]
    std::int64_t lastNs_ = 0;                            // [ns], of the last call of due()
    std::int64_t movedNs_ = 0;                           // [ns], when a step would last have changed something
    bool rests_ = false;
};

}  // namespace master
