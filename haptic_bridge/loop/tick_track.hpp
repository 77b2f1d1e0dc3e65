// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/field_forms.hpp"
#include "haptic_bridge/hand/arm_numbers.hpp"
#include "haptic_bridge/hand/device.hpp"
#include "haptic_bridge/hand/hand_settings.hpp"
#include "haptic_bridge/loop/haptic_tick.hpp"
#include "haptic_bridge/loop/tick.hpp"

namespace haptic_bridge {

/// Properties of the device in one sitting, from a link's start to its end.
struct TrackHeader {
    bool body = false;  // false: a device without a body, such as a recording
    ArmPhysics physics;
    double scale = 1;  // Device::scale()
    HandSettings::Datum datum = HandSettings::Datum::surface;
    bool literal = false;  // Guards::Mode::literal
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        constexpr std::size_t kLongestName = 4096;  // [byte]
        visit("body", it.body);
        visit("name", base::text(it.physics.name, kLongestName));
        for (const ArmNumber& number : kArmNumbers) {
            if (number.member != nullptr) {
                visit(number.name, base::anyFloat(it.physics.*number.member));  // NaN for a device without a body
            }
        }
        visit("delay_ticks", it.physics.delayTicks);
        visit("scale", it.scale);
        visit("datum", it.datum);
        visit("literal", it.literal);
    }
    /// Returns which number no arm has, or an empty text. A replay computes the limits of the forces from these
    /// numbers.
    [[nodiscard]] std::string refusal() const;
};

/// Piece of the tick track, as a message carries it and a journal keeps it. It belongs to one sitting, from a link's
/// start to its end. It holds the sitting's header or consecutive ticks.
struct TrackPiece {
    std::uint32_t sitting = 0;
    bool begins = false;  // true: the piece holds the header, false: ticks
    TrackHeader header;
    std::vector<TickInput> ticks;
};

[[nodiscard]] TrackHeader headerOf(const HapticTick& hand);
[[nodiscard]] base::Bytes encode(const TrackPiece& piece);
/// Returns the piece that encode() wrote as `bytes`. Throws base::FormatError for other bytes.
[[nodiscard]] TrackPiece decodeTrackPiece(std::span<const std::uint8_t> bytes);

/// Largest number of ticks in a piece, so that it fits an ordinary message.
inline constexpr std::size_t kMostTicksInPiece = 400;

/// Returns the title line of the file of --record.
[[nodiscard]] std::string tickTitles();
/// Appends one row of the file of --record to `text`. Each number has the fewest digits that give the same double
/// again.
void appendRow(const Tick& tick, std::string& text);

}  // namespace haptic_bridge
