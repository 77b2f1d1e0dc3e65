// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "haptic_bridge/hand/hand.hpp"
#include "haptic_bridge/hand/pointer.hpp"
#include "haptic_bridge/hand/pointer_arbiter.hpp"
#include "sand/replica.hpp"

namespace haptic_bridge {

/// Makes the paths of the master's own steps from the pointers of the ranks' windows.
///
/// One pointer at a time is the hand (PointerArbiter). While it is pressed, the tool's underside is below the sand's
/// surface, by the depth that take() gets. Otherwise the tool hovers just above. A pointer beside the sand lifts the
/// tool and moves nothing. Used by one thread.
class PointerHand : public Hand {
public:
    static constexpr double kHover = 1.3;  // [tool radius] from the surface to the centre of a tool that hovers
    // Depth of the pressed tool: how far its underside is below the sand's surface [tool radius].
    static constexpr double kUsualDepth = 0.5;
    static constexpr double kShallowest = 0.1, kDeepest = 2;  // at 0 the tool would dig nothing

    /// Begins on `sand`.
    PointerHand(int stepsPerSecond, const sand::Replica& sand);

    /// Takes the reports of a frame, in order of rank, and the depth of their places [tool radius]. `sand` gives the
    /// size of the tool.
    void take(std::span<const PointerReport> reports, double depth, const sand::Replica& sand);

    /// Returns whether a pointer has moved or touched.
    [[nodiscard]] bool pointed() const { return hand_.has_value(); }

private:
    void point(const PointerSample& sample, double depth, const sand::Replica& sand);
    void lift(std::int64_t readNs /* [ns] */);
    void hoverAt(const sand::Replica& sand);

    PointerArbiter arbiter_;
    std::optional<std::size_t> hand_;      // rank of the frame before
    std::optional<std::int32_t> surface_;  // height of the sand at the last place [probe unit]; none beside the sand
    std::int32_t radius_;                  // of the tool that the last place was computed for [probe unit]
};

}  // namespace haptic_bridge
