// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "haptic_bridge/hand/pointer.hpp"

namespace haptic_bridge {

/// Decides which rank's pointer is the hand, because several people may point at one wall.
///
/// The pointer that touched first is the hand until it releases. Then the pointer that has touched longest takes over.
/// While no pointer touches, the one that moved last is the hand. If several ranks touch or move in the same frame, the
/// lowest rank counts as the first. Used by one thread.
class PointerArbiter {
public:
    /// Takes the reports of a frame, in order of rank. Returns the rank whose pointer is the hand in this frame, or
    /// nullopt as long as no pointer has moved or touched. Call it once per frame.
    [[nodiscard]] std::optional<std::size_t> hand(std::span<const PointerReport> reports);

private:
    struct Touch {
        std::size_t rank = 0;
        std::uint32_t number = 0;  // PointerReport::touch
    };
    std::vector<Touch> touches_;       // present touches, the first one first
    std::optional<std::size_t> last_;  // the hand of the frame before
};

}  // namespace haptic_bridge
